#include "filters/particle_cloud.hpp"

#include <algorithm>
#include <cmath>

#include "filters/covariance_factor.hpp"
#include "filters/random.hpp"

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

Gaussian ParticleCloud::moments() const {
  const VectorXd first = states.col(0);  // lest rounding of the mean exceed a small spread
  const MatrixXd about = states.colwise() - first;
  const VectorXd shift = about * weights;
  const MatrixXd anomalies = (about.colwise() - shift) * weights.cwiseSqrt().asDiagonal();
  return {first + shift, covariance_of(anomalies)};
}

Index ParticleCloud::distinct() const {
  Index result = 1;
  for (Index i = 1; i < states.cols(); ++i) result += states.col(i) != states.col(i - 1);
  return result;
}

std::vector<Index> systematic_draws(const VectorXd& weights, double offset) {
  const Index count = weights.size();
  const double share = 1.0 / static_cast<double>(count);
  std::vector<Index> drawn(static_cast<std::size_t>(count));
  double sum = weights[0];
  Index j = 0;
  for (Index i = 0; i < count; ++i) {
    const double place = (static_cast<double>(i) + offset) * share;
    while (place > sum && j + 1 < count) sum += weights[++j];
    drawn[static_cast<std::size_t>(i)] = j;
  }
  return drawn;
}

void ParticleCloud::resample(RandomStream& random) {
  states = states(Eigen::all, systematic_draws(weights, random.uniform())).eval();
  weights.setConstant(1.0 / static_cast<double>(weights.size()));
}

void ParticleCloud::regularise(const std::vector<Index>& entries, RandomStream& random) {
  const Index count = weights.size();
  const auto k = static_cast<double>(entries.size());
  const double bandwidth =
      std::min(0.9, std::pow(4.0 / ((k + 2.0) * static_cast<double>(count)), 1.0 / (k + 4.0)));
  const Gaussian cloud = moments();
  const MatrixXd root = factor_of(cloud.covariance(entries, entries));
  // Draws have the divisor N - 1, the cloud's covariance N.
  const double kernel = bandwidth * std::sqrt(static_cast<double>(count) / static_cast<double>(count - 1));
  const MatrixXd draws = exact_draws(random, root.cols(), count, states.colwise() - cloud.mean).values;
  const double kept = std::sqrt(1.0 - bandwidth * bandwidth);
  const MatrixXd jitter = kernel * root * draws;
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const Index entry = entries[e];
    const double mean = cloud.mean[entry];
    states.row(entry) =
        (kept * (states.row(entry).array() - mean) + mean).matrix() + jitter.row(static_cast<Index>(e));
  }
}

}  // namespace beamid::filters
