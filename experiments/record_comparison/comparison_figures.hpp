// Pictures of a comparison.
#pragma once

#include <vector>

#include "experiments/output/figure.hpp"
#include "experiments/record_comparison/comparison.hpp"

namespace beamid::experiments {

/// Error of every parameter against the number of coordinates, and the record's first output beside what the
/// runs reproduce of it.
std::vector<Figure> figures(const Comparison& comparison);

/// "modal_truncation:modes=3, ukf, forward_euler"; what all runs share is left out.
std::string name_of(const Comparison& comparison, const ComparedRun& run);

}  // namespace beamid::experiments
