// What a filter's run shows about itself.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "filters/diagnostics.hpp"

namespace beamid::experiments {

/// Nothing where fewer than 100 samples were reached.
/// @param unknowns entries of the state that are parameters
std::optional<filters::Diagnostics> diagnostics_of(const filters::FilterRun& run,
                                                   const filters::Gaussian& initial,
                                                   const std::vector<Eigen::Index>& unknowns);

/// A paragraph about the first five, and how many more there were; empty when there were none.
std::string failure_sentences(const std::vector<filters::Failure>& events);

}  // namespace beamid::experiments
