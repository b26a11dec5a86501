#include "experiments/identify/update/directions.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double endless_deviation = 1e3 * open_deviation;  // of a direction that changes nothing

}  // namespace

Directions directions_of(const MatrixXd& derivative, const std::vector<Index>& columns) {
  const Index q = derivative.cols(), count = static_cast<Index>(columns.size());
  Directions found{MatrixXd::Zero(q, q), VectorXd::Zero(q), VectorXd::Zero(q), {}, 0};
  if (count == 0) return found;
  const MatrixXd jacobian = derivative(Eigen::all, columns);
  const Eigen::JacobiSVD<MatrixXd, Eigen::FullPivHouseholderQRPreconditioner> svd(jacobian,
                                                                                  Eigen::ComputeFullV);
  for (Index i = 0; i < count; ++i) {
    const double value = i < svd.singularValues().size() ? svd.singularValues()[i] : 0.0;
    const double deviation =
        value > 1e-8 * svd.singularValues()[0] ? 1.0 / value : std::numeric_limits<double>::infinity();
    VectorXd weights = VectorXd::Zero(q);
    for (Index c = 0; c < count; ++c) weights[columns[static_cast<std::size_t>(c)]] = svd.matrixV()(c, i);
    if (std::isfinite(deviation)) found.covariance += deviation * deviation * weights * weights.transpose();
    if (deviation < open_deviation) {
      ++found.determined;
      continue;
    }
    const double least = std::min(deviation, endless_deviation);
    found.open_share += weights.cwiseAbs2();
    found.open_variance += least * least * weights.cwiseAbs2();
    Index largest = 0;
    weights.cwiseAbs().maxCoeff(&largest);
    if (weights[largest] < 0.0) weights = -weights;
    found.open.push_back({weights, deviation});
  }
  return found;
}

}  // namespace beamid::experiments
