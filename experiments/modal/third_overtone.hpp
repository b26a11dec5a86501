// Whether a decay has the overtone of a sensor that gives less where more is to be measured.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "experiments/modal/dominant_mode.hpp"

namespace beamid::experiments {

/// What a characteristic y(x) = x - b x^3 makes of x = A cos(theta): A (1 - e) cos(theta), e = 3/4 b A^2, and
/// an overtone of amplitude e A / 3, in phase with 3 theta or against it.
struct ThirdOvertone {
  double share = 0;  ///< its amplitude over the mode's, at the first sample
  double compression =
      0;  ///< e there: by how much the mode's own amplitude is too small; negative: too large

  /// By how much the decay's damping ratio comes out too large, relative: amplitudes weigh by their energy,
  /// of which half is compressed by e^2 and less. A tenth of a decay's compression is a tenth of its damping.
  double damping_error() const { return -0.8 * compression; }

  /// "An overtone at three times the frequency, against it, has ...": a sentence for reports.
  std::string words() const;
};

/// Looks at three times the mode's frequency in a signal (N), NaN where nothing was measured, for
/// e^(3 i w t) (c_1 e^(-d t) + c_3 e^(-3 d t)), which is eight times as large as the median of twelve
/// the same around it (of 10^4 signals of noise, one), where a sway or another mode puts some of its own, has
/// half a per cent of the mode's amplitude, and is in phase with it, or against it, to 25 degrees. Nothing
/// where fewer than seven samples are in a period.
std::optional<ThirdOvertone> third_overtone(const Eigen::VectorXd& signal, double interval,
                                            const ModalEstimate& mode);

}  // namespace beamid::experiments
