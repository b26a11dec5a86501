#include "filters/covariance_factor.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "filters/filter.hpp"

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr double unexplained = 1e-14;  // share of a variance that is rounding

// By Cholesky's method, what is left of every diagonal compared before each column. Eigen's LDLT compares
// what they were at first, which for correlations is 1: a dependent entry then stands before independent
// ones.
MatrixXd pivoted_root(MatrixXd left) {
  const Index size = left.rows();
  MatrixXd root(size, size);
  Index rank = 0, largest = 0;
  while (rank < size && left.diagonal().maxCoeff(&largest) > unexplained * static_cast<double>(size)) {
    const VectorXd column = left.col(largest) / std::sqrt(left(largest, largest));
    left.noalias() -= column * column.transpose();
    left.row(largest).setZero();
    left.col(largest).setZero();
    root.col(rank++) = column;
  }
  // Nothing but rounding is left of what has no negative eigenvalue.
  if (!left.allFinite() || left.cwiseAbs().maxCoeff() > 1e-10)
    throw FilterFailure("the covariance has lost its positivity (pivot of its correlation matrix)",
                        left.diagonal().minCoeff());
  return root.leftCols(rank);
}

}  // namespace

MatrixXd factor_of(const MatrixXd& covariance) {
  const Index n = covariance.rows();
  std::vector<Index> uncertain;
  for (Index i = 0; i < n; ++i)
    if (covariance(i, i) != 0.0) uncertain.push_back(i);
  if (uncertain.empty()) return MatrixXd::Zero(n, 1);
  // Correlations, since the units of the states differ widely: pivots are then shares of a variance.
  const VectorXd scale = covariance.diagonal()(uncertain).cwiseSqrt();
  const VectorXd inverse = scale.cwiseInverse();
  const MatrixXd correlation = inverse.asDiagonal() * covariance(uncertain, uncertain) * inverse.asDiagonal();
  const Eigen::LLT<MatrixXd> plain(correlation);
  const bool full =
      plain.info() == Eigen::Success && plain.matrixLLT().diagonal().cwiseAbs2().minCoeff() > unexplained;
  const MatrixXd factor = full ? MatrixXd(plain.matrixL()) : pivoted_root(correlation);
  MatrixXd result = MatrixXd::Zero(n, factor.cols());
  result(uncertain, Eigen::all) = scale.asDiagonal() * factor;
  return result;
}

MatrixXd factor_of(const Gaussian& estimate) {
  return estimate.factor.size() > 0 ? estimate.factor : factor_of(estimate.covariance);
}

MatrixXd covariance_of(const MatrixXd& factor) {
  MatrixXd covariance = MatrixXd::Zero(factor.rows(), factor.rows());
  covariance.selfadjointView<Eigen::Lower>().rankUpdate(factor);
  covariance.triangularView<Eigen::StrictlyUpper>() = covariance.transpose();
  return covariance;
}

Gaussian with_covariance(const Gaussian& estimate) {
  if (estimate.covariance.size() > 0) return estimate;
  return {estimate.mean, covariance_of(estimate.factor), estimate.factor};
}

bool same(const MatrixXd& a, const MatrixXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && a == b;
}

}  // namespace beamid::filters
