// Poles that are near each other.
#pragma once

#include <vector>

#include "experiments/modal/stabilisation.hpp"

namespace beamid::experiments {

/// Indices of the poles of each cluster. Two clusters merge while the mean distance between their poles,
/// |df| / f + |d damping ratio| / 2 + 1 - MAC, is below settings.cluster_distance, or below what
/// settings.resolution_hz is of their frequency.
std::vector<std::vector<std::size_t>> clusters_of(const std::vector<DiagramPole>& poles,
                                                  const StabilisationSettings& settings);

}  // namespace beamid::experiments
