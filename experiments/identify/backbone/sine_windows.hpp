// A free decay in windows of falling amplitude, a damped sine in each.
#pragma once

#include <string>
#include <vector>

#include "experiments/identify/backbone/amplitude_windows.hpp"
#include "experiments/modal/damped_sine_fit.hpp"
#include "experiments/signal/decimation.hpp"

namespace beamid::experiments {

/// The mode in one window.
struct SineWindow {
  Eigen::Index begin = 0, count = 0;  ///< samples of the decimated signal
  DampedSine mode;
  double offset = 0, squares = 0, freedom = 0;

  double left() const;  ///< rms of the residuals [unit of the signal]
};

struct SineWindows {
  std::vector<SineWindow> windows;
  std::string ended;  ///< why no further window was taken
};

/// Window after window from the first sample. Each is as long as the displacement's amplitude takes to fall
/// to WindowSettings::amplitude_ratio, which its own damped sine says.
/// @param frequency_hz of the mode at the beginning
/// @param power of omega by which the signal exceeds a displacement: 2 of an acceleration
SineWindows sine_windows(const DecimatedSignal& coarse, double frequency_hz, double power,
                         const WindowSettings& settings);

}  // namespace beamid::experiments
