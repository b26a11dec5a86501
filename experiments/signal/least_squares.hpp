// Linear least squares that refuse what is not finite.
#pragma once

#include <Eigen/Core>

namespace beamid::experiments {

/// x (n x q) of min |A x - b|, by QR with column pivoting, the columns of A scaled to one: their units
/// differ. What A (m x n) leaves undetermined is zero; without columns x has no rows.
/// @throws std::invalid_argument when A or b holds a value that is not a finite number: no pivot means
/// anything then, and Eigen checks nothing in a release build.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::MatrixXcd complex_least_squares(const Eigen::MatrixXcd& a, const Eigen::MatrixXcd& b);

}  // namespace beamid::experiments
