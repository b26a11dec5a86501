// What no mode makes: lines of machines in random vibration, drift beneath a free decay.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "experiments/record/record.hpp"

namespace beamid::experiments {

/// A sine that lasts over the whole record, as of a machine that turns or of the mains.
struct SteadyLine {
  double frequency_hz = 0.0;
  double share = 0.0;  ///< root mean square over that of the whole record without its means
};

/// The lines of a record and what is left without them.
struct SteadyLines {
  std::vector<SteadyLine> lines;  ///< by rising frequency
  Eigen::MatrixXd rest;           ///< (p x N)
};

/// Sines in random vibration, strongest evidence first, until the rest has none (20 at most).
///
/// Thomson's test [thomson1982] on sine tapers [riedel1995], h_k = sqrt(2 / (N + 1)) sin(pi k t / (N + 1)), k
/// = 1..K, K = 9: a line of complex amplitude mu adds mu H_k, H_k = sum_t h_k, to the transform J_k of every
/// tapered channel, while random vibration whose spectrum is smooth over the tapers' band, (K + 1) / (2 T) to
/// either side, makes the J_k independent of one another. So without a line
///
///     F = (K - 1) sum_c |mu_c|^2 sum_k H_k^2 / sum_c sum_k |J_kc - mu_c H_k|^2,   mu_c = sum_k H_k J_kc /
///     sum_k H_k^2,
///
/// has the law F(2, 2 K - 2) where all channels move as one, and scatters less where they do not. A line is
/// where it is exceeded with probability 0.001 over all frequencies. A mode of damping ratio zeta does not
/// pass for one unless zeta f T < 1: the record is then too short to tell what moves at random from what is
/// steady. A decay does not: a line's amplitudes in the two halves of the record are within a factor of 1.5.
/// @param outputs (p x N), channels of about the same size
SteadyLines steady_lines(const Eigen::MatrixXd& outputs, double interval);

/// A free decay without the drift of its sensor: a mean over two periods is taken off, which does
/// not change frequencies and damping ratios (signal/sway.hpp).
struct DriftFree {
  Record record;        ///< a period shorter at each end
  double period = 0.0;  ///< [s]
  double share = 0.0;   ///< largest, of a channel's motion
};

/// Absent: no channel drifts by a fiftieth of its motion or more, or most of that is done within four
/// periods, as of a hold and its release, or of a hammer's pulse.
/// @param lowest_hz frequency of the lowest mode
std::optional<DriftFree> without_drift(const Record& record, double lowest_hz);

}  // namespace beamid::experiments
