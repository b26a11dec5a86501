// What is wrong with a channel's samples, found once for all who read them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace beamid::experiments {

// How much of a signal is noise.

/// Standard deviation of a signal's broadband noise, taken as white.
///
/// In windows of 512 samples, each without its line and under a Hann window, the median of the periodogram
/// between a quarter and three quarters of half the sampling rate, over ln 2, is the density of white noise:
/// a few modes do not move it, the anti-alias filter lies above, the drift below. Of the windows the quietest
/// quarter counts, as hits are broadband too.
/// @param signal (N), at least 64 samples, finite.
/// @throws std::invalid_argument when the signal is shorter.
double noise_floor(const Eigen::VectorXd& signal);

// How finely a signal's values are resolved.

/// The distinct finite values of a signal and how often each occurs; values that differ by 1e-12 of the
/// largest are one, computed twice.
class ValueSteps {
 public:
  explicit ValueSteps(const std::vector<double>& signal);

  std::size_t distinct() const { return values_.size(); }
  double lowest() const { return values_.front(); }  ///< at least one distinct value
  double highest() const { return values_.back(); }

  /// The smallest difference between neighbouring ones of the sixteen values nearest in order to `value`:
  /// the converter's step there, whatever finer steps numbers printed with few digits have near zero.
  /// Infinite for fewer than two.
  double near(double value) const;

  /// How often a value of the signal occurs.
  std::size_t count(double value) const;

  /// How often the most frequent of the eight values next to `value`, an outermost one, occurs; 0 where there
  /// are fewer.
  std::size_t most_frequent_beside(double value) const;

 private:
  std::size_t place(double value) const;

  std::vector<double> values_;  ///< rising
  std::vector<std::uint32_t> counts_;
};

// Samples that no sensor gives: at the converter's limit, held, absurd, not a number.

struct Run {
  std::size_t first = 0, length = 0;
  double value = 0.0;  ///< NaN where there was none
};

/// Number of samples in all runs.
std::size_t samples_in(const std::vector<Run>& runs);

// `steps` are those of the signal's own values.

/// Clipping: all samples at the signal's highest or lowest value, where that value is a limit. It is one
/// where it is held for three samples, or met three times and three times as often as any of the eight values
/// next to it, and is both reached and left by a jump of at least four of the smallest steps between values
/// near it. A resolved peak stays on its highest value too, when the converter's steps are coarse, but comes
/// and goes by small steps: a sine that is within half a step for three samples is within two a sample later.
/// Where a limit hides among such steps, three runs show it that stay longer than a rounded sine can,
/// clearly. What is held before a release is reached slowly, or held for fifteen times as long as the signal
/// then takes to its median.
std::vector<Run> clipped_runs(const std::vector<double>& signal, const ValueSteps& steps);

/// Drop-outs: samples that are not finite; at most seven zeros in a row, three times or more, between
/// readings that lie on one side, near each other and ten times as far from zero as readings usually lie from
/// the mean of their neighbours; and runs of one value three times as long as the signal's own repetitions
/// explain: with a share r of samples that equal the one before, N samples hold runs up to about log N /
/// log(1/r). At least eight samples, behind motion of eight steps or more in the sixteen samples before,
/// begun or ended by a jump of four: a signal that has come to rest, or has not begun to move, is no
/// drop-out. Nothing for a signal that is constant throughout or rests most of the time.
std::vector<Run> dropped_runs(const std::vector<double>& signal, const ValueSteps& steps);

/// Spikes: one or two samples that are 20 times further from the median of their 64 neighbours than nine in
/// ten of these, further than 95 % of the record from its median, and between samples that are not.
std::vector<Run> spikes(const std::vector<double>& signal);

/// Samples that repeat the one before on a flank, where the signal moves by more than four steps on both
/// sides: a reading that was sent twice. None where as many differences of one step show that rounding
/// explains them (three times as many, 0.3 % of all and ten are needed), or where more than half repeat.
std::vector<Run> repeated_samples(const std::vector<double>& signal, const ValueSteps& steps);

// Broadband noise while a vibration is large: a loose contact that hammers.

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

/// What a signal is taken for.
enum class SignalKind {
  motion,  ///< moves most of the time
  force,   ///< may rest at zero between pulses as short as one sample
};

/// Constant on an offset ten thousand times larger than what moves, or a thousand times and noise.
bool is_dead(const std::vector<double>& samples);

struct Defects {
  bool dead = false;  ///< is_dead() but for spikes
  std::vector<Run> spikes, clipped, dropped, repeated;
  std::optional<Rattle> rattle;
};

/// Each in a signal without those before it: spikes, clipping, drop-outs, repeated samples. Of a force only
/// clipping, where its pulses have flat tops at one value as well: held in two of them, or met in three.
Defects find_defects(const std::vector<double>& samples, SignalKind kind);

}  // namespace beamid::experiments
