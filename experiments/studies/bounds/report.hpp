// What `beamid identifiability` prints, draws and writes.
#pragma once

#include <string>
#include <vector>

#include "experiments/identify/bounds/identifiability.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// All of it. The experiment is the one that the bounds were found of.
Results report(const Experiment& experiment, const Identifiability& found);

Table bound_table(const Identifiability& found);
/// Every combination of the unknowns that is known to a deviation of its own, and those that are silent.
Table combination_table(const Identifiability& found);
Table correlation_table(const Identifiability& found);
/// @param name of the file
/// @param varied,beside heading and key of the first columns, the second where the sweep has it.
Table sweep_table(const Identifiability& found, const BoundSweep& sweep, const std::string& name,
                  const std::string& title, const Column& varied, const Column& beside = {});
Table place_table(const Identifiability& found);

nlohmann::ordered_json values(const Identifiability& found);
std::vector<Figure> figures(const Identifiability& found);

/// What the numbers mean, a paragraph each.
std::vector<std::string> words(const Identifiability& found);

}  // namespace beamid::experiments
