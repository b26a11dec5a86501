#include "experiments/identify/family/shared_estimate.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <stdexcept>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double weak_prior = 1e-4;      // of its information
constexpr double disagree_below = 0.05;  // probability
constexpr double determined = 1.0;       // by the record: an eigenvalue of P0^1/2 I_r P0^1/2 above this

struct EstimatePart {
  std::vector<Index> places;  // in the union
  MatrixXd information;       // I_r
};

// Positive semidefinite: rounding of the difference taken off, and its rank.
MatrixXd information_of(const RecordEstimate& estimate, Index& rank) {
  const VectorXd scale = estimate.prior.diagonal().cwiseSqrt();
  const VectorXd inverse = scale.cwiseInverse();
  const MatrixXd after = inverse.asDiagonal() * estimate.unknowns.covariance * inverse.asDiagonal(),
                 before = inverse.asDiagonal() * estimate.prior * inverse.asDiagonal();
  const MatrixXd raw = after.inverse() - before.inverse(), scaled = 0.5 * (raw + raw.transpose());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(scaled);
  rank = (solver.eigenvalues().array() > determined).count();
  const MatrixXd positive = solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).asDiagonal() *
                            solver.eigenvectors().transpose();
  return inverse.asDiagonal() * positive * inverse.asDiagonal();
}

}  // namespace

SharedEstimate shared_estimate(const std::vector<NamedEstimate>& records) {
  if (records.empty()) throw std::invalid_argument("shared estimate: no record; expected one at least");
  SharedEstimate result;
  std::vector<EstimatePart> parts;
  std::vector<double> prior_mean, prior_information;
  Index rank_in_all = 0;
  for (const NamedEstimate& record : records) {
    EstimatePart part;
    Index rank = 0;
    part.information =
        information_of(record.estimate, rank) / (record.estimate.noise_ratio * record.estimate.noise_ratio);
    rank_in_all += rank;
    for (std::size_t i = 0; i < record.names.size(); ++i) {
      const auto found = std::find(result.names.begin(), result.names.end(), record.names[i]);
      part.places.push_back(found - result.names.begin());
      if (found != result.names.end()) continue;
      const auto at = static_cast<Index>(i);
      const bool nuisance = !record.estimate.nuisance.empty() && record.estimate.nuisance[i];
      result.names.push_back(record.names[i]);
      prior_information.push_back((nuisance ? 1.0 : weak_prior) / record.estimate.prior(at, at));
      prior_mean.push_back(nuisance && record.estimate.start.size() > 0 ? record.estimate.start[at]
                                                                        : record.estimate.unknowns.mean[at]);
    }
    parts.push_back(std::move(part));
  }
  const auto all = static_cast<Index>(result.names.size());
  const VectorXd known = Eigen::Map<const VectorXd>(prior_information.data(), all),
                 before = Eigen::Map<const VectorXd>(prior_mean.data(), all),
                 scale = known.cwiseSqrt().cwiseInverse();
  MatrixXd sum = known.asDiagonal();
  VectorXd weighted = VectorXd::Zero(all);  // of m - m_0
  for (std::size_t r = 0; r < parts.size(); ++r) {
    const std::vector<Index>& at = parts[r].places;
    sum(at, at) += parts[r].information;
    weighted(at) += parts[r].information * (records[r].estimate.unknowns.mean - before(at));
  }
  // In units of the prior no eigenvalue is below 1; where rounding says otherwise the records tell nothing.
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(scale.asDiagonal() * sum * scale.asDiagonal());
  const VectorXd variances = solver.eigenvalues().cwiseMax(1.0).cwiseInverse();
  result.unknowns.covariance =
      scale.asDiagonal() *
      MatrixXd(solver.eigenvectors() * variances.asDiagonal() * solver.eigenvectors().transpose()) *
      scale.asDiagonal();
  result.unknowns.mean = before + result.unknowns.covariance * weighted;
  for (std::size_t r = 0; r < parts.size(); ++r) {
    const VectorXd off = records[r].estimate.unknowns.mean - result.unknowns.mean(parts[r].places);
    result.chi_squared += off.dot(parts[r].information * off);
  }
  result.freedom = std::max(0.0, static_cast<double>(rank_in_all - all));
  if (result.freedom > 0.0) {
    const boost::math::chi_squared law(result.freedom);
    result.probability = cdf(complement(law, result.chi_squared));
    if (result.probability < disagree_below)
      result.scatter = std::max(1.0, std::sqrt(result.chi_squared / result.freedom));
    result.unknowns.covariance *= result.scatter * result.scatter;
  }
  return result;
}

}  // namespace beamid::experiments
