#include "filters/identifiability.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

void require_scale(const VectorXd& scale, Index unknowns) {
  if (scale.size() != unknowns)
    throw std::invalid_argument("sizes of " + std::to_string(scale.size()) + " unknowns; expected " +
                                std::to_string(unknowns));
  for (Index i = 0; i < unknowns; ++i)
    if (!(scale[i] > 0.0 && std::isfinite(scale[i])))
      throw std::invalid_argument("size of unknown " + std::to_string(i) + " is " + std::to_string(scale[i]) +
                                  "; expected a positive number");
}

// From the singular values of the scaled factor, largest first, and its right singular vectors.
InformationReport report(const VectorXd& singular, const MatrixXd& vectors, const VectorXd& lengths,
                         const VectorXd& scale, double threshold) {
  const Index r = scale.size();
  InformationReport result;
  result.scale = scale;
  result.eigenvalues = singular.cwiseAbs2();
  result.combinations = vectors;
  for (auto column : result.combinations.colwise()) {
    Index largest = 0;
    column.cwiseAbs().maxCoeff(&largest);
    if (column[largest] < 0.0) column = -column;
  }
  while (result.rank < r && singular[result.rank] > threshold * singular[0]) ++result.rank;
  result.condition = result.rank < r ? infinity : result.eigenvalues[0] / result.eigenvalues[r - 1];

  // Square root of the pseudo-inverse of the scaled information: its rows are as long as the bounds.
  const MatrixXd inverse =
      result.combinations.leftCols(result.rank) * singular.head(result.rank).cwiseInverse().asDiagonal();
  const VectorXd deviations = inverse.rowwise().norm();
  result.bounds = scale.cwiseProduct(deviations);
  result.conditional_bounds.resize(r);
  result.correlations.setIdentity(r, r);
  for (Index i = 0; i < r; ++i) {
    if (!result.determined(i)) result.bounds[i] = infinity;
    result.conditional_bounds[i] = lengths[i] > 0.0 ? scale[i] / lengths[i] : infinity;
    for (Index j = 0; j < i; ++j)
      if (deviations[i] > 0.0 && deviations[j] > 0.0)
        result.correlations(i, j) = result.correlations(j, i) =
            inverse.row(i).dot(inverse.row(j)) / (deviations[i] * deviations[j]);
  }
  return result;
}

}  // namespace

bool InformationReport::determined(Index i) const {
  return rank == combinations.cols() || undetermined().row(i).norm() <= negligible_entry;
}

InformationReport determined_combinations(const InformationFactor& information, const VectorXd& scale,
                                          double threshold) {
  require_scale(scale, information.unknowns());
  const MatrixXd scaled = information.root() * scale.asDiagonal();
  const Eigen::JacobiSVD<MatrixXd> svd(scaled, Eigen::ComputeFullV);
  return report(svd.singularValues(), svd.matrixV(), scaled.colwise().norm().transpose(), scale, threshold);
}

InformationReport determined_combinations(const MatrixXd& information, const VectorXd& scale,
                                          double threshold) {
  if (information.rows() != information.cols() || information.rows() == 0)
    throw std::invalid_argument("information is " + std::to_string(information.rows()) + " x " +
                                std::to_string(information.cols()) + "; expected a square matrix");
  require_scale(scale, information.rows());
  if (!information.allFinite() || !information.isApprox(information.transpose(), 1e-12))
    throw std::invalid_argument("information must be finite and symmetric");
  const MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(scaled);
  if (eigen.eigenvalues()[0] < -1e-10 * scaled.norm())
    throw std::invalid_argument("information has the negative eigenvalue " +
                                std::to_string(eigen.eigenvalues()[0]) + "; expected none");
  return report(eigen.eigenvalues().reverse().cwiseMax(0.0).cwiseSqrt(),
                eigen.eigenvectors().rowwise().reverse(), scaled.diagonal().cwiseMax(0.0).cwiseSqrt(), scale,
                threshold);
}

}  // namespace beamid::filters
