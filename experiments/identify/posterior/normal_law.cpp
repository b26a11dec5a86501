#include "experiments/identify/posterior/normal_law.hpp"

#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <limits>
#include <numbers>

namespace beamid::experiments {
namespace {

// Not by way of long double, whose table overflows where a processor (valgrind's) has but 64 bits of it.
using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

}  // namespace

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
