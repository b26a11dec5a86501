// A record as lines of its spectrum.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "experiments/models/motion/supported_response.hpp"
#include "filters/measurements.hpp"

namespace beamid::experiments {

/// Discrete Fourier transforms over N samples, divided by sqrt(N): white noise of deviation sigma has
/// E |X|^2 = sigma^2 at every line.
struct RecordLines {
  Eigen::Index samples = 0;          ///< N
  double interval = 0.0;             ///< [s]
  Eigen::VectorXd omega;             ///< 2 pi k / (N dt), k = 1, 2, ... (L) [rad/s]
  Eigen::MatrixXcd outputs, inputs;  ///< (p x L), (m x L)
};

/// The lines above zero, up to a frequency; absent: 0.6 of half the sampling rate, below which the step
/// `decimate` lets nothing fold back (signal/decimation.hpp). Of the last samples as many are left out as the
/// transform's length needs to be a product of 2, 3 and 5.
/// @param inputs of the m (m x N); outputs are those of the record
/// @throws std::invalid_argument where stamps are uneven, a reading is missing, the frequency is not below
/// half the sampling rate, or there are fewer than 64 samples or 8 lines.
RecordLines record_lines(const filters::Measurements& record, const Eigen::MatrixXd& inputs,
                         const std::optional<double>& highest_hz);

/// What free motion has at these lines: real and imaginary part of each in turn, all outputs of one line,
/// then those of the next (p L x c); of length 1 each.
///
///     sum_t z^t e^(-i w t dt) = (1 - z^N) / (1 - z e^(-i w dt)),    z = e^(lambda dt)
Eigen::MatrixXcd free_lines(const SupportedResponse::FreeMotion& motion, const RecordLines& record);

}  // namespace beamid::experiments
