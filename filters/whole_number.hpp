// Options that count things.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace beamid::filters {

/// The number as a count. @param owner and option read like "enkf" and "members".
/// @param most of things that take memory; 2^53 for other numbers.
/// @throws std::invalid_argument when it is not a whole number from `least` to `most`.
inline Eigen::Index whole_number(double value, Eigen::Index least, const std::string& owner,
                                 const std::string& option, Eigen::Index most = Eigen::Index{1} << 53) {
  if (std::floor(value) == value && value >= static_cast<double>(least) && value <= static_cast<double>(most))
    return static_cast<Eigen::Index>(value);
  std::ostringstream message;
  message << owner << ": " << option << " is " << value << "; expected a whole number of at least " << least;
  if (value > static_cast<double>(most)) message << " and at most " << most;
  throw std::invalid_argument(message.str());
}

}  // namespace beamid::filters
