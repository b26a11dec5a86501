// Checks of options that several methods share.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include "filters/options.hpp"

namespace beamid::reduction {

/// Value of a number that counts something.
/// @throws std::invalid_argument "option 'modes' of reduction 'pod' is 1.5; expected a whole number from 1".
inline Eigen::Index count_option(const filters::Options& options, const std::string& name,
                                 const std::string& method, double least) {
  constexpr double most = 1e6;
  const double value = options.number(name);
  if (value >= least && value <= most && value == std::floor(value)) return static_cast<Eigen::Index>(value);
  std::ostringstream message;
  message << "option '" << name << "' of reduction '" << method << "' is " << value
          << "; expected a whole number from " << least << " to " << most;
  throw std::invalid_argument(message.str());
}

/// Value of a number above zero.
inline double positive_option(const filters::Options& options, const std::string& name,
                              const std::string& method) {
  const double value = options.number(name);
  if (value > 0.0 && std::isfinite(value)) return value;
  std::ostringstream message;
  message << "option '" << name << "' of reduction '" << method << "' is " << value
          << "; expected a finite number above 0";
  throw std::invalid_argument(message.str());
}

/// @throws std::invalid_argument when a method is to find more shapes than the system has coordinates.
inline void require_at_most(Eigen::Index count, Eigen::Index most, const std::string& name,
                            const std::string& method) {
  if (count > most)
    throw std::invalid_argument("option '" + name + "' of reduction '" + method + "' is " +
                                std::to_string(count) + "; expected at most " + std::to_string(most) +
                                " for this system");
}

}  // namespace beamid::reduction
