// An estimate of a state, and the names of what is estimated.
#pragma once

#include <Eigen/Core>
#include <string>

namespace beamid::filters {

/// Mean (n) and covariance, either as a matrix or as a factor.
///
/// A state of thousands of entries whose uncertainty has few directions is carried by a factor alone: no
/// n x n matrix is ever formed.
struct Gaussian {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;   ///< P (n x n); empty where only the factor is kept
  Eigen::MatrixXd factor = {};  ///< L (n x r), P = L L^T; empty where only the covariance is kept

  /// The block of P that belongs to entries first .. first + count - 1 (count x count).
  Eigen::MatrixXd marginal(Eigen::Index first, Eigen::Index count) const {
    if (covariance.size() > 0) return covariance.block(first, first, count, count);
    const auto rows = factor.middleRows(first, count);
    return rows * rows.transpose();
  }

  /// Square roots of the diagonal of P (n).
  Eigen::VectorXd deviations() const {
    if (covariance.size() > 0) return covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
    return factor.rowwise().norm();
  }
};

/// Name and SI unit of a state or an output.
struct Label {
  std::string name;
  std::string unit;
};

}  // namespace beamid::filters
