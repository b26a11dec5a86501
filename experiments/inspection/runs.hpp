// Runs of samples that no sensor gives: at the converter's limit, at zero, not a number.
#pragma once

#include <cstddef>
#include <vector>

namespace beamid::experiments {

struct Run {
  std::size_t first = 0, length = 0;
  double value = 0.0;  ///< NaN where there was none
};

/// Clipping: three samples or more at the signal's highest or lowest value, reached or left by a jump of at
/// least four of its smallest steps. A resolved peak stays on its highest value too, when the converter's
/// steps are coarse, but it comes and goes by small steps.
std::vector<Run> clipped_runs(const std::vector<double>& signal);

/// Drop-outs: samples that are not finite, and runs of one value three times as long as the signal's own
/// repetitions explain: with a share r of samples that equal the one before, N samples hold runs up to about
/// log N / log(1/r). At least eight samples; nothing for a signal that is constant throughout.
std::vector<Run> dropped_runs(const std::vector<double>& signal);

}  // namespace beamid::experiments
