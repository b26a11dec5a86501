// Pictures of a comparison.
#pragma once

#include <vector>

#include "experiments/identify/compare/comparison.hpp"
#include "experiments/results/figure.hpp"

namespace beamid::experiments {

/// Error of every parameter against the number of coordinates, and the record's first output beside what the
/// runs reproduce of it.
std::vector<Figure> figures(const Comparison& comparison);

/// "modal_truncation:modes=3, ukf, forward_euler"; what all runs share is left out.
std::string name_of(const Comparison& comparison, const ComparedRun& run);

}  // namespace beamid::experiments
