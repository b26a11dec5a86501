// Options that count things.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <stdexcept>
#include <string>

namespace beamid::filters {

/// The number as a count. @param owner and option read like "enkf" and "members".
/// @throws std::invalid_argument when it is not a whole number of at least `least`, or beyond 2^53.
inline Eigen::Index whole_number(double value, Eigen::Index least, const std::string& owner,
                                 const std::string& option) {
  if (std::floor(value) == value && value >= static_cast<double>(least) && value <= 0x1p53)
    return static_cast<Eigen::Index>(value);
  throw std::invalid_argument(owner + ": " + option + " is " + std::to_string(value) +
                              "; expected a whole number of at least " + std::to_string(least));
}

}  // namespace beamid::filters
