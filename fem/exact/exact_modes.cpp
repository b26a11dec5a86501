#include "fem/exact/exact_modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>

#include "fem/exact/beam_chain.hpp"

namespace beamid::fem {
namespace {

using Eigen::Index, Eigen::VectorXd;

int count_below(const std::vector<HarmonicChain>& chains, double omega) {
  return std::accumulate(chains.begin(), chains.end(), 0,
                         [&](int sum, const HarmonicChain& chain) { return sum + chain.count_below(omega); });
}

// The smallest interval of numbers around root `wanted` (from 1): fewer roots lie below its begin. Every
// count is kept for the roots to come.
std::pair<double, double> bracket(const std::vector<HarmonicChain>& chains, int wanted,
                                  std::map<double, int>& counts) {
  while (counts.rbegin()->second < wanted) {
    const double next = 2.0 * counts.rbegin()->first;
    counts[next] = count_below(chains, next);
  }
  const auto above =
      std::find_if(counts.begin(), counts.end(), [&](const auto& known) { return known.second >= wanted; });
  double low = std::prev(above)->first, high = above->first;
  while (high - low > std::numeric_limits<double>::epsilon() * high) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    const int count = counts[middle] = count_below(chains, middle);
    (count < wanted ? low : high) = middle;
  }
  return {low, high};
}

// Of the modes between low and high the one that is `which` from the first, at positions [m].
VectorXd shape(const std::vector<HarmonicChain>& chains, double low, double high, int which,
               const VectorXd& positions) {
  VectorXd w = VectorXd::Zero(positions.size());
  for (const HarmonicChain& chain : chains) {
    const int here = chain.count_below(high) - chain.count_below(low);
    if (which >= here && &chain != &chains.back()) {
      which -= std::max(0, here);
      continue;
    }
    std::vector<Index> order;
    for (Index i = 0; i < positions.size(); ++i)
      if (positions[i] >= chain.nodes.front().position && positions[i] <= chain.nodes.back().position)
        order.push_back(i);
    std::sort(order.begin(), order.end(), [&](Index a, Index b) { return positions[a] < positions[b]; });
    std::vector<double> sorted;
    for (const Index i : order) sorted.push_back(positions[i]);
    const VectorXd part = chain.deflection(0.5 * (low + high), std::min(which, 1), sorted);
    for (Index i = 0; i < part.size(); ++i) w[order[i]] = part[i];
    break;
  }
  return w;
}

void scale_to_one(Eigen::Ref<VectorXd> shape) {
  if (shape.size() == 0) return;
  Index largest = 0;
  if (shape.cwiseAbs().maxCoeff(&largest) > 1e-10)
    shape /= double{shape[largest]};
  else  // every position asked for is a node of the mode
    shape.setZero();
}

}  // namespace

std::optional<ExactModes> exact_modes(const Beam& beam, Index count, const VectorXd& positions) {
  if (count < 1)
    throw std::invalid_argument("count of modes is " + std::to_string(count) + "; expected at least 1");
  const auto whole = chain_of(beam);
  for (Index i = 0; i < positions.size(); ++i)
    if (!(positions[i] >= 0.0 && positions[i] <= beam.length())) {
      std::ostringstream message;
      message << "position is " << positions[i] << " m; expected between 0 and the beam's length, "
              << beam.length() << " m";
      throw std::invalid_argument(message.str());
    }
  if (!whole) return {};
  const std::vector<HarmonicChain> chains = split_where_clamped(*whole);
  const Eigen::Matrix2Xd rigid = chains.size() == 1 ? rigid_motions(chains[0]) : Eigen::Matrix2Xd(2, 0);
  const auto rigid_count = static_cast<int>(rigid.cols());
  const double length = beam.length(),
               start = std::sqrt(whole->pieces[0].bending_stiffness / whole->pieces[0].mass_per_length) /
                       (length * length);
  if (!(start > 0.0 && std::isfinite(start)))
    throw std::invalid_argument(
        "exact modes: the beam's length, stiffness and mass lie too far apart for double precision; expected "
        "all of them in SI units");
  if (beam.axial_load > 0.0 && count_below(chains, rigid_count > 0 ? 1e-7 * start : 0.0) > rigid_count)
    throw std::runtime_error("exact modes: the beam is unstable, its axial load is beyond buckling");

  ExactModes modes;
  modes.angular_frequency = VectorXd::Zero(count);
  modes.deflection = Eigen::MatrixXd::Zero(positions.size(), count);
  std::map<double, int> counts{{0.0, rigid_count}, {start, count_below(chains, start)}};
  for (Index j = 0; j < count; ++j) {
    if (j < rigid_count) {
      modes.deflection.col(j) = (rigid(0, j) + rigid(1, j) * positions.array()).matrix();
    } else {
      const auto [low, high] = bracket(chains, static_cast<int>(j) + 1, counts);
      modes.angular_frequency[j] = 0.5 * (low + high);
      modes.deflection.col(j) = shape(chains, low, high, static_cast<int>(j) - counts[low], positions);
    }
    scale_to_one(modes.deflection.col(j));
  }
  return modes;
}

}  // namespace beamid::fem
