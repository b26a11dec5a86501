// The study's outcome as tables, figures, words and numbers.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "experiments/results/results.hpp"
#include "experiments/studies/paper/outcome.hpp"

namespace beamid::experiments::paper {

/// Modal analysis: tip mass, first frequency, damping ratio (its table 1).
Table table_1(const Outcome& outcome);
/// The simulated oscillator: published errors, ours, and the closed form (its table 2).
Table table_2(const Outcome& outcome);
/// Filter against closed form where nothing but the discretisation is left.
Table bias_table(const Outcome& outcome);
/// K, C and damping ratio of the beams (its table 3).
Table table_3(const Outcome& outcome);
/// K/M against w^2 (its table 4).
Table table_4(const Outcome& outcome);
/// Damping error against xi sqrt(Meq), with the law's prediction (its table 5).
Table table_5(const Outcome& outcome);
/// Wide prior and unmodelled modes: the second cause of failure.
Table second_cause_table(const Outcome& outcome);
/// Both schemes before the chain of 2009 and before the tuned one.
Table chain_table(const Outcome& outcome);
/// Zero-phase filtering, with its end transients left out and kept.
Table zero_phase_table(const Outcome& outcome);
/// Mean and rms error over the seeded trials against the Cramer-Rao bound.
Table trials_table(const Outcome& outcome);
/// Error of Rayleigh's equivalent mass.
Table reduction_table(const Outcome& outcome);

std::vector<Figure> figures(const Outcome& outcome);
Attachment mode_shapes(const Outcome& outcome);

/// Headings, paragraphs and tables in the order in which they are read.
void add_finding(const Outcome& outcome, Results& results);

/// The keys of results.json.
nlohmann::ordered_json values(const Outcome& outcome);
/// Those of what the argument rests on, beside the paper's own tables.
nlohmann::ordered_json argument_values(const Outcome& outcome);
nlohmann::ordered_json configuration(const Outcome& outcome);

}  // namespace beamid::experiments::paper
