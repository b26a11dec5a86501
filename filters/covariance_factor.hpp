// Covariances as factors P = L L^T with few columns.
#pragma once

#include <Eigen/Core>

#include "filters/gaussian.hpp"

namespace beamid::filters {

/// L (n x r) with L L^T = covariance (n x n), r its rank to rounding, but at least one column. Lower
/// triangular where the covariance has full rank. @throws FilterFailure when it is not positive semidefinite.
Eigen::MatrixXd factor_of(const Eigen::MatrixXd& covariance);

/// The factor that an estimate carries (n x r), or else one of its covariance. @throws FilterFailure
Eigen::MatrixXd factor_of(const Gaussian& estimate);

/// L L^T (n x n), exactly symmetric.
Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& factor);

/// The same estimate with both its covariance and a factor of it.
Gaussian with_covariance(const Gaussian& estimate);

/// Whether two matrices have the same shape and entries.
bool same(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace beamid::filters
