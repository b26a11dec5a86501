// Pictures of a comparison.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/identify/engine/comparison.hpp"
#include "experiments/results/figure.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// Error of every parameter against the number of coordinates, and the record's first output beside what the
/// runs reproduce of it.
std::vector<Figure> figures(const Comparison& comparison);

/// "modal_truncation:modes=3, ukf, forward_euler"; what all runs share is left out.
std::string name_of(const Comparison& comparison, const ComparedRun& run);

// What a comparison says, in words.

/// A paragraph each: what every reduction cost in accuracy and saved in time against the largest model, and
/// what the discretisations did.
std::vector<std::string> words(const Comparison& comparison);

/// The run that the others are measured against: no reduction where there is one, else the most coordinates.
/// Null when nothing converged.
const ComparedRun* reference_run(const Comparison& comparison);

/// What runs say, each text once, behind the names of the runs that say it where there are several.
std::vector<std::string> said_once(
    const Comparison& comparison,
    const std::function<std::vector<std::string>(const ComparedRun&)>& texts_of);

// A comparison as text, tables, figures and JSON.

// Lags of channels with clocks of their own, for a report.

/// The lags as a table and as "clocks" in the values; nothing where all channels keep one clock.
void add_clocks(Results& results, const Comparison& comparison);

/// Tables, figures, words and results.json keys.
Results report(const Experiment& experiment, const Comparison& comparison);

}  // namespace beamid::experiments
