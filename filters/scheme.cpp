#include "filters/scheme.hpp"

#include <limits>
#include <stdexcept>

namespace beamid::filters {

SchemeRegistry& scheme_registry() {
  static SchemeRegistry registry("discretisation");
  return registry;
}

std::complex<double> seen_through(const Scheme& scheme, std::complex<double> mu, double dt) {
  const std::complex<double> target = std::exp(mu * dt);
  constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon();
  std::complex<double> z = mu * dt;
  for (int iteration = 0; iteration < 50; ++iteration) {
    const auto [value, derivative] = scheme.amplification(z);
    const std::complex<double> change = (value - target) / derivative;
    z -= change;
    if (std::abs(change * derivative) <= rounding * std::abs(target)) return z / dt;
  }
  throw std::runtime_error(
      "no step of this discretisation reproduces the motion: the interval is too long for it");
}

}  // namespace beamid::filters
