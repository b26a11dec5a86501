#include "filters/diagnostics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <Eigen/Eigenvalues>
#include <boost/math/distributions/chi_squared.hpp>

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

Whiteness whiteness_of(const VectorXd& series, Index lags) {
  Whiteness result{VectorXd::Zero(lags)};
  const auto there = !series.array().isNaN();
  const Index count = there.count();
  if (count == 0 || lags < 1) {
    result.p_value = 1.0;
    return result;
  }
  const auto n = static_cast<double>(count);
  const double mean = there.select(series, 0.0).sum() / n;
  const VectorXd centred = there.select(series.array() - mean, 0.0);
  const bool all = count == series.size();
  const VectorXd present = all ? VectorXd() : VectorXd(there.cast<double>());
  const double power = centred.squaredNorm();
  const bool usual = power > 0.0 && std::isfinite(power);
  double statistic = 0.0;
  Index degrees = 0;
  for (Index lag = 1; lag <= lags; ++lag) {
    const Index overlap = series.size() - lag;
    if (overlap < 1) break;
    const double pairs =
        all ? static_cast<double>(overlap) : present.head(overlap).dot(present.tail(overlap));
    if (pairs == 0.0) continue;
    const double r = usual ? centred.head(overlap).dot(centred.tail(overlap)) / power : 1.0;
    result.autocorrelation[lag - 1] = r;
    statistic += n * (n + 2.0) * r * r / pairs;
    ++degrees;
  }
  result.p_value =
      degrees == 0 ? 1.0 : cdf(complement(boost::math::chi_squared(static_cast<double>(degrees)), statistic));
  return result;
}

namespace {

// Bounds that the mean of so many chi-square variables of one degree leaves with probability `outside`.
std::pair<double, double> band(double freedoms, double outside) {
  const boost::math::chi_squared distribution(freedoms);
  return {quantile(distribution, 0.5 * outside) / freedoms,
          quantile(distribution, 1.0 - 0.5 * outside) / freedoms};
}

}  // namespace

InnovationConsistency innovation_consistency(const FilterRun& run) {
  constexpr Index fewest = 100, parts = 10;
  const Index reached = run.failure ? run.failure->step : run.normalised_squares.size();
  std::vector<Index> told;  // samples that told something, and how many outputs did
  std::vector<double> outputs;
  for (Index k = 0; k < reached; ++k)
    if (const Index count = (!run.innovations.col(k).array().isNaN()).count(); count > 0) {
      told.push_back(k);
      outputs.push_back(static_cast<double>(count));
    }
  const auto samples = static_cast<Index>(told.size());
  if (samples < fewest)
    throw std::invalid_argument("innovations: " + std::to_string(samples) + "; expected at least " +
                                std::to_string(fewest));
  const VectorXd squares = run.normalised_squares(told);
  const Eigen::Map<const VectorXd> degrees(outputs.data(), samples);

  InnovationConsistency result;
  result.mean_normalised_square = squares.sum() / degrees.sum();
  std::tie(result.lower_95, result.upper_95) = band(degrees.sum(), 0.05);
  const Index part = samples / parts;
  result.windows.resize(parts);
  double fewest_degrees = degrees.sum();  // the band is that of the window where the fewest were measured
  for (Index i = 0; i < parts; ++i) {
    const double all = degrees.segment(i * part, part).sum();
    result.windows[i] = squares.segment(i * part, part).sum() / all;
    fewest_degrees = std::min(fewest_degrees, all);
  }
  std::tie(result.window_lower_95, result.window_upper_95) = band(fewest_degrees, 0.05 / parts);

  const Whiteness whiteness = whiteness_of(run.whitened_innovations.row(0).head(reached).transpose());
  result.lag_one_correlation = whiteness.autocorrelation[0];
  result.whiteness_p_value = whiteness.p_value;
  return result;
}

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
