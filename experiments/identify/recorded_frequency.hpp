// What frequency a record shows, whatever model looks at it: an aid, never a condition.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

namespace beamid::experiments {

struct RecordedFrequency {
  std::optional<double> value_hz;  ///< absent: could not be had
  std::string failure;             ///< why not
};

/// Of the mode near the expected frequency: with measured inputs from the response to them (forced_mode),
/// without any as a free decay (dominant_mode).
/// @param output (N), @param inputs (m x N), m may be 0
RecordedFrequency recorded_frequency(const Eigen::VectorXd& output, const Eigen::MatrixXd& inputs,
                                     double interval, double expected_hz);

}  // namespace beamid::experiments
