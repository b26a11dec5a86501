// Weighted samples of a state.
#pragma once

#include <vector>

#include "filters/gaussian.hpp"
#include "filters/random.hpp"

namespace beamid::filters {

/// Which of N come to be drawn, N times in rising order, each as often as its weight says (their sum is one):
/// from one number in (0, 1), systematic resampling [kitagawa1996].
std::vector<Eigen::Index> systematic_draws(const Eigen::VectorXd& weights, double offset);

/// N states in the columns of `states` (n x N), their weights summing to one.
struct ParticleCloud {
  Eigen::MatrixXd states;
  Eigen::VectorXd weights;

  /// Mean and covariance, sum w_i (z_i - m)(z_i - m)^T.
  Gaussian moments() const;

  /// 1 / sum w_i^2: how many equal weights would be worth as much [kong1994].
  double effective_size() const { return 1.0 / weights.squaredNorm(); }

  /// How many are not copies of their neighbour, as resampling leaves them.
  Eigen::Index distinct() const;

  /// As many copies of each as its weight says (systematic_draws).
  void resample(RandomStream& random);

  /// z_i := m + a (z_i - m) + b L xi_i for `entries` of the state (k), a^2 + b^2 = 1, xi_i of exact moments,
  /// uncorrelated with the states: a Gaussian kernel of the bandwidth b that is best for Gaussians
  /// [musso2001], shrunk so that mean and covariance P = L L^T of these entries do not change [liu2001].
  /// Weights must be equal.
  void regularise(const std::vector<Eigen::Index>& entries, RandomStream& random);
};

}  // namespace beamid::filters
