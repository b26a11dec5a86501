// Whether the frequency of a free decay jumps while the motion goes on: the sampling rate changed.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "experiments/modal/dominant_mode.hpp"

namespace beamid::experiments {

/// One oscillation before an instant, another one behind it.
struct FrequencyJump {
  double time = 0;  ///< [s], from the first sample
  double before_hz = 0, behind_hz = 0;

  double ratio() const { return behind_hz / before_hz; }
  std::string words() const;  ///< "the frequency jumps from 3.456 to 6.911 Hz, 2.000 times"
};

/// The clearest jump of the frequency of a decay (N, finite), by a fifth at least, where there is one. In
/// eight periods of the mode before and behind an instant, but for one period to either side, the signal,
/// decimated to sixteen samples per cycle, is
///
///     a parabola + b e^(s t) + c e^(r s t),    r = behind_hz / before_hz, from the peaks of both spectra.
///
/// It is a jump where |c| < 0.3 |b| before and |b| < 0.3 |c| behind, |b| and |c| lie within a factor of two
/// of each other and above eight of their deviations, what is left is less than a fifth of the signal's
/// energy, and the peaks stand still over four periods more on both sides: a frequency that follows the
/// amplitude does not. No free motion does that: a mode that is not there before an instant is not there
/// behind it. Stamps that are an index times one interval do, where the logger halves its rate.
std::optional<FrequencyJump> frequency_jump(const Eigen::VectorXd& signal, double interval,
                                            const ModalEstimate& mode);

}  // namespace beamid::experiments
