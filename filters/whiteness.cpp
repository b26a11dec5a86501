#include "filters/whiteness.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

namespace beamid::filters {

using Eigen::Index, Eigen::VectorXd;

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
  const VectorXd present = there.cast<double>();
  const double power = centred.squaredNorm();
  const bool usual = power > 0.0 && std::isfinite(power);
  double statistic = 0.0;
  Index degrees = 0;
  for (Index lag = 1; lag <= lags; ++lag) {
    const Index overlap = series.size() - lag;
    if (overlap < 1) break;
    const double pairs = present.head(overlap).dot(present.tail(overlap));
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

}  // namespace beamid::filters
