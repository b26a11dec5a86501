#include "filters/covariance_factor.hpp"

#include <Eigen/Cholesky>
#include <limits>
#include <vector>

#include "filters/filter.hpp"

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

MatrixXd factor_of(const MatrixXd& covariance) {
  constexpr double rounding = 1e-14;  // share of a variance that the others leave unexplained
  const Index n = covariance.rows();
  std::vector<Index> uncertain;
  for (Index i = 0; i < n; ++i)
    if (covariance(i, i) != 0.0) uncertain.push_back(i);
  if (uncertain.empty()) return MatrixXd::Zero(n, 1);
  // Correlations, since the units of the states differ widely: pivots are then shares of a variance.
  const VectorXd scale = covariance.diagonal()(uncertain).cwiseSqrt();
  const VectorXd inverse = scale.cwiseInverse();
  const MatrixXd correlation = inverse.asDiagonal() * covariance(uncertain, uncertain) * inverse.asDiagonal();
  const auto size = static_cast<Index>(uncertain.size());
  MatrixXd factor;
  const Eigen::LLT<MatrixXd> plain(correlation);
  if (plain.info() == Eigen::Success && plain.matrixLLT().diagonal().cwiseAbs2().minCoeff() > rounding) {
    factor = plain.matrixL();
  } else {
    const Eigen::LDLT<MatrixXd> pivoted(correlation);
    const VectorXd pivots = pivoted.vectorD();
    if (!pivots.allFinite() || pivots.minCoeff() < -1e-10)
      throw FilterFailure("the covariance has lost its positivity (pivot of its correlation matrix)",
                          pivots.allFinite() ? pivots.minCoeff() : std::numeric_limits<double>::quiet_NaN());
    Index rank = 0;  // pivots come largest first
    while (rank < size && pivots[rank] > rounding * static_cast<double>(size)) ++rank;
    const MatrixXd lower = pivoted.matrixL();
    factor = pivoted.transpositionsP().transpose() *
             MatrixXd(lower.leftCols(rank) * pivots.head(rank).cwiseSqrt().asDiagonal());
  }
  MatrixXd result = MatrixXd::Zero(n, factor.cols());
  result(uncertain, Eigen::all) = scale.asDiagonal() * factor;
  return result;
}

MatrixXd factor_of(const Gaussian& belief) {
  return belief.factor.size() > 0 ? belief.factor : factor_of(belief.covariance);
}

MatrixXd covariance_of(const MatrixXd& factor) {
  MatrixXd covariance = MatrixXd::Zero(factor.rows(), factor.rows());
  covariance.selfadjointView<Eigen::Lower>().rankUpdate(factor);
  covariance.triangularView<Eigen::StrictlyUpper>() = covariance.transpose();
  return covariance;
}

Gaussian with_covariance(const Gaussian& belief) {
  if (belief.covariance.size() > 0) return belief;
  return {belief.mean, covariance_of(belief.factor), belief.factor};
}

bool same(const MatrixXd& a, const MatrixXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && a == b;
}

}  // namespace beamid::filters
