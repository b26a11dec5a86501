// A mode of a record that was driven throughout by measured inputs.
#pragma once

#include <Eigen/Core>

namespace beamid::experiments {

struct ForcedMode {
  double frequency_hz = 0;  ///< undamped
  double damping_ratio = 0;
};

/// The mode near an expected frequency, from the lines s = i 2 pi k / T of output and inputs between 0.7 and
/// 1.4 times it. Whatever the motion begins and ends with, a record of length T obeys
///
///     (s^2 + 2 xi w s + w^2) Y = sum_j (b_j0 + b_j1 s + b_j2 s^2) U_j + c_0 + c_1 s + c_2 s^2
///
/// the c being what start and end differ by, the b with the modes outside the band. Linear least squares in
/// all coefficients, the lines weighed by the left side's factor of the iteration before [sanathanan1963].
///
/// It is meant for a first estimate: noise of the inputs biases it, and so does, by up to half an interval,
/// how they ran between samples.
/// @param output (N), @param inputs (m x N); what is missing is bridged
/// @throws std::invalid_argument when the band holds too few lines, or no mode that explains half of them.
ForcedMode forced_mode(const Eigen::VectorXd& output, const Eigen::MatrixXd& inputs, double interval,
                       double expected_hz);

}  // namespace beamid::experiments
