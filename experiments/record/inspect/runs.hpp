// Samples that no sensor gives: at the converter's limit, held, absurd, not a number.
#pragma once

#include <cstddef>
#include <vector>

namespace beamid::experiments {

struct Run {
  std::size_t first = 0, length = 0;
  double value = 0.0;  ///< NaN where there was none
};

/// Number of samples in all runs.
std::size_t samples_in(const std::vector<Run>& runs);

/// Clipping: all samples at the signal's highest or lowest value, where that value is a limit. It is one
/// where it is held for three samples, or met three times and three times as often as any of the eight values
/// next to it, and is both reached and left by a jump of at least four of the smallest steps between values
/// near it. A resolved peak stays on its highest value too, when the converter's steps are coarse, but comes
/// and goes by small steps: a sine that is within half a step for three samples is within two a sample later.
/// Where a limit hides among such steps, three runs show it that stay longer than a rounded sine can,
/// clearly. What is held before a release is reached slowly, or held for fifteen times as long as the signal
/// then takes to its median.
std::vector<Run> clipped_runs(const std::vector<double>& signal);

/// Drop-outs: samples that are not finite, and runs of one value three times as long as the signal's own
/// repetitions explain: with a share r of samples that equal the one before, N samples hold runs up to about
/// log N / log(1/r). At least eight samples, behind motion of eight steps or more in the sixteen samples
/// before, begun or ended by a jump of four: a signal that has come to rest, or has not begun to move, is no
/// drop-out. Nothing for a signal that is constant throughout or rests most of the time.
std::vector<Run> dropped_runs(const std::vector<double>& signal);

/// Spikes: one or two samples that are 20 times further from the median of their 64 neighbours than nine in
/// ten of these, further than 95 % of the record from its median, and between samples that are not.
std::vector<Run> spikes(const std::vector<double>& signal);

/// Samples that repeat the one before on a flank, where the signal moves by more than four steps on both
/// sides: a reading that was sent twice. None where as many differences of one step show that rounding
/// explains them (three times as many, 0.3 % of all and ten are needed), or where more than half repeat.
std::vector<Run> repeated_samples(const std::vector<double>& signal);

}  // namespace beamid::experiments
