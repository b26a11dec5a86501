// Steps that Gaussian filters share: weighing an innovation, and noticing numerical trouble.
#pragma once

#include <Eigen/Cholesky>

#include "filters/filter.hpp"

namespace beamid::filters {

/// Gain G = cross S^-1 (n x p) for cross = cov(z, y) (n x p); fills the correction's normalised square and
/// log-likelihood from its innovation and S. @throws FilterFailure when S is not positive definite.
Eigen::MatrixXd weigh(Correction& correction, const Eigen::MatrixXd& cross,
                      Eigen::LLT<Eigen::MatrixXd>& factor);

/// Lower L (n x n) with L L^T = covariance, also where it is only semidefinite (a state known exactly).
/// @throws FilterFailure when an eigenvalue is negative beyond rounding.
Eigen::MatrixXd square_root(const Eigen::MatrixXd& covariance, Eigen::LLT<Eigen::MatrixXd>& factor);

/// Replaces P by (P + P^T) / 2.
void symmetrise(Eigen::MatrixXd& covariance);

/// @throws FilterFailure when the mean or the covariance's diagonal is not finite, or a variance is negative.
void check_finite(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance);
void check_finite(const Gaussian& estimate);

/// @throws FilterFailure that S is not positive definite, with its smallest eigenvalue.
[[noreturn]] void refuse(const Eigen::MatrixXd& innovation_covariance);

/// Whether a square matrix is finite, symmetric to 1e-12 and positive semidefinite to 1e-12.
bool is_covariance(const Eigen::MatrixXd& matrix);

/// @throws std::invalid_argument when the estimate does not fit the model, has neither covariance nor factor
/// or two that disagree, or its covariance is not symmetric positive semidefinite.
void check_estimate(const Gaussian& estimate, const DiscreteModel& model);

}  // namespace beamid::filters
