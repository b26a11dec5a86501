// What in a decay follows the amplitude: frequency, damping ratio, and the overtone of a sensor that
// saturates.
#pragma once

#include <complex>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "experiments/modal/dominant_mode.hpp"

namespace beamid::experiments {

// A straight line through the logarithm of a decaying analytic signal.

/// Slope of a line through log z, and where it belongs.
struct EnvelopeLine {
  std::complex<double> slope;
  double time = 0;           ///< weighted mean [s]
  double log_amplitude = 0;  ///< there
  double deviation = 0;      ///< of either part of the slope [1/s]
};

/// Least squares, weighted by |z|^2: the inverse variance of log z under steady noise, whose mean it does not
/// move, log|1 + n| being harmonic in n. The deviation is s^2 correlation / integral of |z|^2 (t - mean)^2,
/// with s^2 from the residuals.
/// @param time (M) [s], @param logarithm (M) of z, phase unwrapped
/// @param independent share of the values that are: interval / correlation length of the noise
EnvelopeLine line_through(const Eigen::VectorXd& time, const Eigen::VectorXcd& logarithm, double independent);

/// log|z| + i arg z, the phase unwrapped from value to value.
Eigen::VectorXcd unwrapped_logarithm(const Eigen::VectorXcd& z);

/// A mode around one instant of its decay. Windows overlap by half: every second point is independent.
struct AmplitudePoint {
  double time = 0;                                      ///< after the first sample [s]
  double amplitude = 0;                                 ///< [unit of the signal]
  double frequency_hz = 0, frequency_deviation_hz = 0;  ///< undamped
  double damping_ratio = 0, damping_ratio_deviation = 0;
};

/// The window of the analytic signal, and where a decay is over.
struct AmplitudeSettings {
  double window = 0;               ///< [s]; 0: the amplitude falls by e^-0.35, three kernels at least
  double largest_deviation = 0.2;  ///< of the damping ratio, relative; where it is larger the decay is over
};

/// z(t) = sum_k h_k y(t + k dt) e^(-i w (t + k dt)), the mode's analytic signal brought to rest
/// [feldman2011]: h is a Kaiser window (60 dB) so long that neighbours, offset and the image at -w lie beyond
/// its first zero. A finite h has no poles: a mode e^(s t) leaves as a constant times e^((s - i w) t), from
/// the first window to the last, where a Hilbert transform would need its ends cut.
struct Demodulated {
  Eigen::VectorXcd values;  ///< (M); half the amplitude's complex envelope, gain of h taken off
  double start = 0;         ///< of the first value, after the signal's first sample [s]
  double interval = 0;      ///< [s]
  double correlation = 0;   ///< length over which white noise stays correlated, 1 / integral of h^2 [s]
};

/// @param signal (N) @param rate of the mode [rad/s] @param others rates of the other modes
/// @throws std::invalid_argument when the signal is shorter than `fewest_kernels` kernels.
Demodulated demodulate(const Eigen::VectorXd& signal, double interval, std::complex<double> rate,
                       const std::vector<std::complex<double>>& others, double fewest_kernels = 4);

/// Lines through log z over windows, weighted by |z|^2 (the inverse variance of log z): the real part's slope
/// is minus the damping rate, the imaginary part's the distance from w. The point belongs to the weighted
/// mean of time and of log amplitude, to which the slope belongs where it varies.
///
/// Deviations are those of the slopes, s^2 correlation / integral of |z|^2 (t - mean)^2, with s^2 from the
/// window's own residuals. The points end where the damping ratio's deviation exceeds `largest_deviation`;
/// they begin, in the first half, where it does not: what else a hit moves dies out before.
std::vector<AmplitudePoint> amplitude_dependence(const Eigen::VectorXd& signal, double interval,
                                                 std::complex<double> rate,
                                                 const std::vector<std::complex<double>>& others,
                                                 const AmplitudeSettings& settings = {});

/// Frequency and damping ratio that change along a decay, with its amplitude.
struct AmplitudeTrend {
  AmplitudePoint first, last;
  bool frequency = false, damping = false;  ///< which of them changes

  /// "frequency 5.1 to 5 Hz, damping ratio 1.2 to 0.9 %"
  std::string changes() const;
};

/// The first and the last of the points where they differ by five standard deviations, in frequency by 0.2 %
/// or in damping ratio by a fifth as well, and the point in the middle lies between them to three: of a decay
/// of constant frequency and damping one in a million does. Three points at least.
std::optional<AmplitudeTrend> amplitude_trend(const std::vector<AmplitudePoint>& points);

/// How well the motion at n times a frequency follows that at the frequency in amplitude and phase: the
/// coherence |sum z_n conj(z_1^n)|^2 / (sum |z_n|^2 sum |z_1^n|^2) of the signals brought to rest, 1 of an
/// overtone of a characteristic that is not linear, also where the frequency drifts. 0 of a signal of less
/// than five periods.
double overtone_coherence(const Eigen::VectorXd& signal, double interval, double frequency_hz, int n);

// Whether a decay has the overtone of a sensor that gives less where more is to be measured.

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
