// The word a user probably meant.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace beamid::experiments {

/// The candidate with the fewest insertions, deletions, replacements and swaps of neighbours from `word`, if
/// it takes at most a third of the word's letters (and at least two may differ).
std::optional<std::string> nearest(const std::string& word, const std::vector<std::string>& candidates);

/// "ekf, enkf, ukf"
std::string joined(const std::vector<std::string>& words);

}  // namespace beamid::experiments
