#include "experiments/identify/compare/known_prior.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

filters::Gaussian of_unknowns(const JointModel& model, const filters::Gaussian& estimate) {
  const auto q = static_cast<Index>(model.unknown_places.size());
  filters::Gaussian part{VectorXd(q), MatrixXd(q, q)};
  for (Index i = 0; i < q; ++i) {
    const Index at = model.unknown_places[i];
    part.mean[i] = estimate.mean[at];
    for (Index j = 0; j < q; ++j) {
      const Index other = model.unknown_places[j];
      part.covariance(i, j) = estimate.covariance.size() > 0
                                  ? estimate.covariance(at, other)
                                  : estimate.factor.row(at).dot(estimate.factor.row(other));
    }
  }
  return part;
}

double move_of(const JointModel& model, const VectorXd& from, const filters::Gaussian& to) {
  const filters::Gaussian unknowns = of_unknowns(model, to);
  const VectorXd moved = unknowns.mean - from(model.unknown_places);
  double largest = 0.0;
  for (Index j = 0; j < moved.size(); ++j)
    if (!model.unknowns[static_cast<std::size_t>(j)].nuisance && unknowns.covariance(j, j) > 0.0)
      largest = std::max(largest, std::abs(moved[j]) / std::sqrt(unknowns.covariance(j, j)));
  return largest;
}

void take_known_prior(const JointModel& model, const filters::Gaussian& start, const FirstGuess& known,
                      const VectorXd& known_mean, filters::Gaussian& last) {
  const auto& places = model.unknown_places;
  const VectorXd first = start.mean(places);
  if (last.covariance.size() == 0) {
    const VectorXd weighed = known.unknowns.ldlt().solve(known_mean - first);
    if (!weighed.allFinite()) return;
    const MatrixXd rows = last.factor(places, Eigen::all);
    last.mean += last.factor * (rows.transpose() * weighed);
    return;
  }
  const auto q = static_cast<Index>(places.size());
  const MatrixXd before = known.unknowns.inverse(), working = of_unknowns(model, start).covariance.inverse(),
                 change = before - working;
  const MatrixXd columns = last.covariance(Eigen::all, places), block = columns(places, Eigen::all);
  const MatrixXd less =
      columns * change * (MatrixXd::Identity(q, q) + block * change).inverse() * columns.transpose();
  if (!less.allFinite()) return;
  const VectorXd pull = before * known_mean - working * first - change * last.mean(places);
  last.covariance -= 0.5 * (less + less.transpose());
  last.mean += last.covariance(Eigen::all, places) * pull;
  last.factor.resize(0, 0);
}

}  // namespace beamid::experiments
