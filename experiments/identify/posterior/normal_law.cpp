#include "experiments/identify/posterior/normal_law.hpp"

#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "experiments/signal/in_double.hpp"

namespace beamid::experiments {

double below_normal(double u) {
  return 0.5 * std::erfc(-u / std::numbers::sqrt2);
}

double normal_quantile(double share) {
  if (!(share > 0.0)) return -std::numeric_limits<double>::infinity();
  if (!(share < 1.0)) return std::numeric_limits<double>::infinity();
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * share, InDouble{});
}

double normal_density(double u) {
  return std::exp(-0.5 * u * u) * 0.5 * std::numbers::inv_sqrtpi * std::numbers::sqrt2;
}

}  // namespace beamid::experiments
