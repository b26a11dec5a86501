// Broadband noise while a vibration is large: a loose contact that hammers.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

namespace beamid::experiments {

struct Rattle {
  std::size_t first = 0, last = 0;  ///< samples between which it is heard
  double ratio = 1;                 ///< of its noise to that of the quiet rest, in standard deviations
};

/// In windows of 64 to 512 samples of the signal's fourth differences, which hardly hold low modes (and whose
/// own gain is divided out again), under a Blackman-Harris window [harris1978], the lower quartile of the
/// periodogram between a quarter and three quarters of half the sampling rate measures noise whatever few
/// lines there are. It rattles where, in three windows or more in succession, that is nine times the record's
/// own lower quartile, a tenth of the band's mean or more (lines of higher modes are far above it) and a
/// hundredth of the motion's mean square at most, while the signal is larger there than elsewhere.
/// @param signal (N), finite. @param step between its values, whose rounding is a noise that ends where the
/// motion is smaller than that. @return nothing below 1024 samples.
std::optional<Rattle> find_rattle(const Eigen::VectorXd& signal, double step);

}  // namespace beamid::experiments
