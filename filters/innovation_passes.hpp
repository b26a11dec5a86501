// Many linear models on one record, by the vector engine.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "filters/linear_gaussian.hpp"

namespace beamid::filters {

/// What the Kalman filter of one model says of a record: innovations e_k and their covariances S_k.
struct InnovationPass {
  Eigen::MatrixXd innovations;        ///< (p x N); NaN where an output was not read
  Eigen::MatrixXd covariances;        ///< S of every step, of the outputs read (p p x steps at least)
  std::vector<std::int64_t> step_of;  ///< (N)
  double squares = 0.0;               ///< sum_k e_k^T S_k^-1 e_k
  double log_determinants = 0.0;      ///< sum_k ln det S_k
  bool failed = false;                ///< some S_k is not positive, or the likelihood is not finite

  double cost() const { return 0.5 * (squares + log_determinants); }  ///< -ln L but for a constant
  auto covariance(Eigen::Index k) const {                             ///< S_k (p x p)
    const Eigen::Index p = innovations.rows();
    return Eigen::Map<const Eigen::MatrixXd>(covariances.col(step_of[static_cast<std::size_t>(k)]).data(), p,
                                             p);
  }
};

/// As kalman_pass(), of several models of one shape, four side by side where the processor has AVX2, else
/// two.
/// @param covariances whether they are asked for; without, they are empty
/// @throws std::invalid_argument where stamps are uneven
std::vector<InnovationPass> innovation_passes(const std::vector<LinearGaussian>& models,
                                              const Measurements& record, double interval, bool covariances);

}  // namespace beamid::filters
