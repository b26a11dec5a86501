#include "filters/innovation_consistency.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <stdexcept>
#include <string>
#include <tuple>

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::VectorXd;

// Autocorrelation of a series (N) at lags 1..count; one where the series is constant or beyond all bounds.
VectorXd autocorrelation(const VectorXd& series, Index count) {
  const VectorXd centred = series.array() - series.mean();
  const double power = centred.squaredNorm();
  if (!(power > 0.0 && std::isfinite(power))) return VectorXd::Ones(count);
  VectorXd result(count);
  for (Index lag = 1; lag <= count; ++lag) {
    const Index overlap = centred.size() - lag;
    result[lag - 1] = centred.head(overlap).dot(centred.tail(overlap)) / power;
  }
  return result;
}

// Bounds that the mean of `samples` chi-square variables of `outputs` degrees, per output, leaves with
// probability `outside`.
std::pair<double, double> band(double samples, double outputs, double outside) {
  const double freedoms = samples * outputs;
  const boost::math::chi_squared distribution(freedoms);
  return {quantile(distribution, 0.5 * outside) / freedoms,
          quantile(distribution, 1.0 - 0.5 * outside) / freedoms};
}

}  // namespace

InnovationConsistency innovation_consistency(const FilterRun& run) {
  constexpr Index fewest = 100, parts = 10, lags = 20;
  const Index samples = run.failure ? run.failure->step : run.normalised_squares.size();
  if (samples < fewest)
    throw std::invalid_argument("innovations: " + std::to_string(samples) + "; expected at least " +
                                std::to_string(fewest));
  const auto outputs = static_cast<double>(run.innovations.rows());
  const VectorXd squares = run.normalised_squares.head(samples) / outputs;

  InnovationConsistency result;
  result.mean_normalised_square = squares.mean();
  std::tie(result.lower_95, result.upper_95) = band(static_cast<double>(samples), outputs, 0.05);
  const Index part = samples / parts;
  result.windows.resize(parts);
  for (Index i = 0; i < parts; ++i) result.windows[i] = squares.segment(i * part, part).mean();
  std::tie(result.window_lower_95, result.window_upper_95) =
      band(static_cast<double>(part), outputs, 0.05 / parts);

  const VectorXd correlation =
      autocorrelation(run.whitened_innovations.row(0).head(samples).transpose(), lags);
  result.lag_one_correlation = correlation[0];
  const auto n = static_cast<double>(samples);
  double statistic = 0.0;  // Q = n (n + 2) sum r_k^2 / (n - k), chi-square of as many degrees as lags
  for (Index k = 1; k <= lags; ++k)
    statistic += n * (n + 2.0) * correlation[k - 1] * correlation[k - 1] / (n - static_cast<double>(k));
  result.whiteness_p_value = cdf(complement(boost::math::chi_squared(static_cast<double>(lags)), statistic));
  return result;
}

}  // namespace beamid::filters
