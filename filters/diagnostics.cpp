#include "filters/diagnostics.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr double range = 5.0;

MatrixXd covariance_at(const Gaussian& estimate, const std::vector<Index>& entries) {
  for (const Index entry : entries)
    if (entry < 0 || entry >= estimate.mean.size())
      throw std::invalid_argument("unknown " + std::to_string(entry) + " does not exist; expected 0 to " +
                                  std::to_string(estimate.mean.size() - 1));
  if (estimate.covariance.size() > 0) return estimate.covariance(entries, entries);
  const MatrixXd rows = estimate.factor(entries, Eigen::all);
  return rows * rows.transpose();
}

Index reached(const FilterRun& run) {
  return run.failure ? run.failure->step : run.normalised_squares.size();
}

double normal_share(double from, double to) {
  return 0.5 * (std::erfc(-to / std::sqrt(2.0)) - std::erfc(-from / std::sqrt(2.0)));
}

}  // namespace

InnovationHistogram innovation_histogram(const FilterRun& run, Index bins) {
  if (bins < 2) throw std::invalid_argument("bins: " + std::to_string(bins) + "; expected at least 2");
  const auto whitened = run.whitened_innovations.leftCols(reached(run));
  constexpr double infinity = std::numeric_limits<double>::infinity();
  InnovationHistogram result{VectorXd::LinSpaced(bins + 1, -range, range),
                             MatrixXd::Zero(whitened.rows(), bins), MatrixXd::Zero(whitened.rows(), bins)};
  for (Index i = 0; i < whitened.rows(); ++i) {
    for (const double value : whitened.row(i)) {
      if (std::isnan(value)) continue;
      const double place = std::floor((value + range) / (2.0 * range) * static_cast<double>(bins));
      result.counts(i, static_cast<Index>(std::clamp(place, 0.0, static_cast<double>(bins - 1)))) += 1.0;
    }
    for (Index b = 0; b < bins; ++b)
      result.expected(i, b) =
          result.counts.row(i).sum() *
          normal_share(b == 0 ? -infinity : result.edges[b], b == bins - 1 ? infinity : result.edges[b + 1]);
  }
  return result;
}

std::optional<InformationGain> information_gain(const MatrixXd& before, const MatrixXd& after) {
  if (before.rows() != before.cols() || after.rows() != before.rows() || after.cols() != before.cols() ||
      !before.allFinite() || !after.allFinite())
    throw std::invalid_argument("covariances are " + std::to_string(before.rows()) + " x " +
                                std::to_string(before.cols()) + " and " + std::to_string(after.rows()) +
                                " x " + std::to_string(after.cols()) +
                                "; expected finite square ones of one size");
  if (before.rows() == 0 || !(before.diagonal().minCoeff() > 0.0)) return std::nullopt;
  const VectorXd unit = before.diagonal().cwiseSqrt().cwiseInverse();
  const MatrixXd prior = unit.asDiagonal() * before * unit.asDiagonal();
  if (Eigen::LLT<MatrixXd>(prior).info() != Eigen::Success) return std::nullopt;
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> eigen(
      unit.asDiagonal() * (0.5 * (after + after.transpose())) * unit.asDiagonal(), prior);
  InformationGain result{eigen.eigenvalues().cwiseMax(0.0), eigen.eigenvectors().colwise().normalized()};
  result.rank = (result.ratios.array() < 0.5).count();
  const double least = 1.0 / result.ratios.maxCoeff() - 1.0, most = 1.0 / result.ratios.minCoeff() - 1.0;
  result.condition =
      least > 0.0 && std::isfinite(most) ? most / least : std::numeric_limits<double>::infinity();
  return result;
}

Diagnostics diagnose(const FilterRun& run, const Gaussian& initial, const std::vector<Index>& unknowns) {
  Diagnostics result;
  const Index samples = reached(run);
  const auto told = (!run.normalised_squares.head(samples).array().isNaN()).count();
  if (told >= 100) result.consistency = innovation_consistency(run);
  for (Index i = 0; i < run.whitened_innovations.rows(); ++i)
    result.whiteness.push_back(whiteness_of(run.whitened_innovations.row(i).head(samples).transpose()));
  result.histogram = innovation_histogram(run);
  const MatrixXd before = covariance_at(initial, unknowns), after = covariance_at(run.last, unknowns);
  if (!unknowns.empty() && before.allFinite() && after.allFinite())
    result.information = information_gain(before, after);
  result.log_likelihood = run.log_likelihood;
  return result;
}

}  // namespace beamid::filters
