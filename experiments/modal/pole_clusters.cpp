#include "experiments/modal/pole_clusters.hpp"

#include <algorithm>
#include <cmath>

namespace beamid::experiments {
namespace {

using Eigen::Index;

/// 1 where two poles merge at the latest.
double distance(const Pole& a, const Pole& b, const StabilisationSettings& settings) {
  const double larger = std::max(a.frequency_hz(), b.frequency_hz());
  const double apart = std::abs(a.frequency_hz() - b.frequency_hz()) / larger;
  const double all =
      apart + 0.5 * std::abs(a.damping_ratio() - b.damping_ratio()) + 1 - modal_assurance(a.shape, b.shape);
  return all / std::max(settings.cluster_distance, settings.resolution_hz / larger);
}

}  // namespace

std::vector<std::vector<std::size_t>> clusters_of(const std::vector<DiagramPole>& poles,
                                                  const StabilisationSettings& settings) {
  const auto count = static_cast<Index>(poles.size());
  Eigen::MatrixXd apart(count, count);
  for (Index i = 0; i < count; ++i)
    for (Index j = 0; j < count; ++j) apart(i, j) = distance(poles[i].pole, poles[j].pole, settings);
  std::vector<std::vector<std::size_t>> clusters(poles.size());
  for (std::size_t i = 0; i < poles.size(); ++i) clusters[i] = {i};
  std::vector<Index> alive(poles.size());
  for (Index i = 0; i < count; ++i) alive[i] = i;
  for (;;) {
    double nearest = 1;
    Index first = -1, second = -1;
    for (std::size_t a = 0; a < alive.size(); ++a)
      for (std::size_t b = a + 1; b < alive.size(); ++b)
        if (const double d = apart(alive[a], alive[b]); d < nearest) {
          nearest = d;
          first = alive[a];
          second = alive[b];
        }
    if (first < 0) break;
    const auto m = static_cast<double>(clusters[first].size()),
               n = static_cast<double>(clusters[second].size());
    for (const Index other : alive)  // average linkage by Lance and Williams
      apart(first, other) = apart(other, first) =
          (m * apart(first, other) + n * apart(second, other)) / (m + n);
    clusters[first].insert(clusters[first].end(), clusters[second].begin(), clusters[second].end());
    clusters[second].clear();
    alive.erase(std::find(alive.begin(), alive.end(), second));
  }
  std::erase_if(clusters, [](const auto& cluster) { return cluster.empty(); });
  return clusters;
}

}  // namespace beamid::experiments
