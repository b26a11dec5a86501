// Options of the scaled unscented transform, with what they must not be.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "filters/algorithms/sigma_points.hpp"
#include "filters/registry.hpp"

namespace beamid::filters::algorithms {

inline std::vector<OptionSpec> scaled_spread_options() {
  return {{"alpha", 1.0, "", "spread of the sigma points"},
          {"beta", 2.0, "", "weight of the second-order mean shift in the covariance; 2 suits a Gaussian"},
          {"kappa", 0.0, "", "secondary spread; n + kappa must be positive"}};
}

/// c = alpha^2 (n + kappa), gamma = beta - alpha^2. @throws std::invalid_argument where weights would break
/// the covariance's positivity, or points so close that rounding of f is all that their differences hold.
inline Spread scaled_spread(const std::string& owner, const Options& options, std::size_t states) {
  const double alpha = options.number("alpha"), kappa = options.number("kappa");
  const double n = static_cast<double>(states), square = alpha * alpha * (n + kappa);
  const double centre = options.number("beta") - alpha * alpha;
  if (!(alpha > 0.0 && square > 0.0 && std::isfinite(square)))
    throw std::invalid_argument(owner + ": alpha and n + kappa must be positive; found alpha " +
                                std::to_string(alpha) + ", n + kappa " + std::to_string(n + kappa));
  if (!(std::sqrt(square) >= 1e-4))
    throw std::invalid_argument(owner +
                                ": alpha is too small: sigma points nearer to the mean than 1e-4 standard "
                                "deviations, alpha sqrt(n + kappa), are lost in rounding");
  if (!(centre >= 0.0 && std::isfinite(centre)))
    throw std::invalid_argument(owner + ": beta is " + std::to_string(options.number("beta")) +
                                "; expected at least alpha^2 = " + std::to_string(alpha * alpha) +
                                ", else covariances may turn negative");
  return {std::sqrt(square), centre, true};
}

/// The cubature rule: 2n points at sqrt(n) standard deviations, alike in weight.
inline Spread cubature_spread(std::size_t states) {
  return {std::sqrt(static_cast<double>(states)), 0.0, false};
}

}  // namespace beamid::filters::algorithms
