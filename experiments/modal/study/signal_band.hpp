// Where in frequency the modes of a record lie.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "experiments/modal/study/record_lines.hpp"

namespace beamid::experiments {

/// From 2 cycles in the record (samples p x N) to 1.3 times the highest frequency at which a channel's
/// spectrum reaches a twentieth of its peak [Hz], at most 0.45 of the sampling rate.
std::pair<double, double> signal_band(const Eigen::MatrixXd& samples, double interval);

/// The same of a free decay: at least to 1.3 times its highest line, however soon that dies out.
std::pair<double, double> decay_band(const Eigen::MatrixXd& samples, double interval,
                                     const std::vector<RecordLine>& lines);

/// @throws std::invalid_argument unless 0 <= from < to < half the sampling rate, with 2 cycles of `to` in the
/// record.
void check_band(std::pair<double, double> band_hz, double interval, Eigen::Index count);

}  // namespace beamid::experiments
