#include "filters/innovation.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>

namespace beamid::filters {
namespace {

using Eigen::MatrixXd;

// Variances of modes that have died out reach the numbers next to zero, which have no digits.
constexpr double no_innovation = 1e-280;

double smallest_eigenvalue(const MatrixXd& matrix) {
  if (!matrix.allFinite()) return std::numeric_limits<double>::quiet_NaN();
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

}  // namespace

MatrixXd weigh(Correction& correction, const MatrixXd& cross, Eigen::LLT<MatrixXd>& factor) {
  const MatrixXd& s = correction.innovation_covariance;
  factor.compute(s);
  if (factor.info() != Eigen::Success || !s.allFinite()) refuse(s);
  correction.whitened = factor.matrixL().solve(correction.innovation);
  const auto p = static_cast<double>(s.rows());
  correction.normalised_square = correction.whitened.squaredNorm();
  const double log_determinant = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
  correction.log_likelihood =
      -0.5 * (correction.normalised_square + log_determinant + p * std::log(2.0 * std::numbers::pi));
  if (cross.rows() == 0) return cross;  // Eigen's solver would bind a reference to the first of no numbers
  return factor.solve(cross.transpose()).transpose();
}

MatrixXd square_root(const MatrixXd& covariance, Eigen::LLT<MatrixXd>& factor) {
  factor.compute(covariance);
  if (factor.info() == Eigen::Success) return factor.matrixL();
  if (!covariance.allFinite())
    throw FilterFailure("the covariance is not finite", std::numeric_limits<double>::quiet_NaN());
  if (covariance.diagonal().minCoeff() < -no_innovation)
    throw FilterFailure("a variance is negative", smallest_eigenvalue(covariance));
  // Semidefinite to rounding: clip. Correlation form, since the units of the states may differ widely.
  const Eigen::VectorXd scale = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd inverse = (scale.array() > 0.0).select(scale.cwiseInverse(), 0.0);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> correlation(inverse.asDiagonal() * covariance *
                                                            inverse.asDiagonal());
  const double smallest = correlation.eigenvalues()[0];
  if (smallest < -1e-10)
    throw FilterFailure("the covariance has lost its positivity (eigenvalue of its correlation matrix)",
                        smallest);
  return scale.asDiagonal() * correlation.eigenvectors() *
         correlation.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

void symmetrise(MatrixXd& covariance) {
  for (Eigen::Index j = 0; j < covariance.cols(); ++j)
    for (Eigen::Index i = 0; i < j; ++i)
      covariance(i, j) = covariance(j, i) = 0.5 * (covariance(i, j) + covariance(j, i));
}

void check_finite(const Eigen::VectorXd& mean, const MatrixXd& covariance) {
  if (!mean.allFinite()) throw FilterFailure("the mean is not finite", smallest_eigenvalue(covariance));
  const auto variances = covariance.diagonal().array();
  if (!(variances >= -no_innovation).all() || !variances.allFinite())
    throw FilterFailure("a variance is negative or not finite", smallest_eigenvalue(covariance));
}

void check_finite(const Gaussian& estimate) {
  check_finite(estimate.mean, estimate.covariance);
}

void refuse(const MatrixXd& innovation_covariance) {
  throw FilterFailure("the innovation covariance is not positive definite",
                      smallest_eigenvalue(innovation_covariance));
}

bool is_covariance(const MatrixXd& matrix) {
  return matrix.allFinite() && matrix.isApprox(matrix.transpose(), 1e-12) &&
         smallest_eigenvalue(matrix) >= -1e-12 * matrix.norm();
}

void check_estimate(const Gaussian& estimate, const DiscreteModel& model) {
  const auto n = static_cast<Eigen::Index>(model.state_labels().size());
  const MatrixXd &covariance = estimate.covariance, &factor = estimate.factor;
  const bool has_covariance = covariance.size() > 0 || factor.size() == 0;
  const auto size = [](const MatrixXd& matrix) {
    return std::to_string(matrix.rows()) + " x " + std::to_string(matrix.cols());
  };
  if (estimate.mean.size() != n || (has_covariance && (covariance.rows() != n || covariance.cols() != n)))
    throw std::invalid_argument("initial estimate has a mean of " + std::to_string(estimate.mean.size()) +
                                " and a covariance of " + size(has_covariance ? covariance : factor) +
                                "; expected " + std::to_string(n));
  if (factor.size() > 0 && factor.rows() != n)
    throw std::invalid_argument("initial estimate has a factor of " + size(factor) + "; expected " +
                                std::to_string(n) + " rows");
  if (!estimate.mean.allFinite() || !factor.allFinite())
    throw std::invalid_argument("initial mean and factor must be finite");
  if (has_covariance && !is_covariance(covariance))
    throw std::invalid_argument("initial covariance must be finite, symmetric and positive semidefinite");
  if (covariance.size() > 0 && factor.size() > 0 &&
      (covariance - factor * factor.transpose()).norm() > 1e-9 * covariance.norm())
    throw std::invalid_argument(
        "initial covariance and factor disagree; expected the same estimate, or only one");
}

}  // namespace beamid::filters
