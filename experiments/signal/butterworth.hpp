// Butterworth filters by the bilinear transform.
#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

namespace beamid::experiments {

// Recursive filters as cascades of second-order sections.

/// One second-order section, H(z) = (b0 + b1/z + b2/z^2) / (1 + a1/z + a2/z^2).
struct Biquad {
  double b0 = 1, b1 = 0, b2 = 0;
  double a1 = 0, a2 = 0;
};

/// Sections applied one after the other. Its coefficients belong to one sampling interval.
struct CascadedFilter {
  std::vector<Biquad> sections;
  double interval = 1;  ///< [s]
};

/// What precedes the first sample.
enum class FilterStart {
  rest,   ///< zeros
  steady  ///< the first sample, for ever: a constant then passes without a transient
};

/// Both filters in series. @throws std::invalid_argument when their intervals differ.
CascadedFilter cascade(const CascadedFilter& first, const CascadedFilter& second);

/// Causal filtering, y = H x, of a signal (N).
///
/// An oscillation e^(s t) leaves as H(e^(s dt)) e^(s t): amplitude and phase change, frequency and damping do
/// not. Before that settles, a transient made of the filter's own poles decays (see settling_samples).
Eigen::VectorXd filter_causally(const CascadedFilter& filter, const Eigen::VectorXd& signal,
                                FilterStart start = FilterStart::rest);

/// Zero-phase filtering, forwards and then backwards, of a signal (N): e^(s t) leaves as
/// zero_phase_response(s) e^(s t).
///
/// Each end is extended by its odd reflection, as long as the filter's impulse response lasts (but at most
/// N - 1 samples), and each pass starts in its steady state [gustafsson1996]: constants and straight lines
/// pass without end effects. An oscillation does not: unless it is odd about the record's end, the reflection
/// has a kink there. A free decay that starts at the record's first sample hence carries a transient at both
/// ends, of about settling_samples, which callers must discard.
/// @throws std::invalid_argument when the signal has fewer than two samples.
Eigen::VectorXd filter_forward_backward(const CascadedFilter& filter, const Eigen::VectorXd& signal);

/// H(e^(s dt)) at the complex rate s = -damping rate + i w [rad/s].
std::complex<double> response(const CascadedFilter& filter, std::complex<double> rate);

/// H(e^(s dt)) H(e^(-s dt)): what forward-backward filtering does to e^(s t).
std::complex<double> zero_phase_response(const CascadedFilter& filter, std::complex<double> rate);

/// Samples after which the filter's slowest pole r has decayed to `tolerance`, the smallest n with
/// |r|^n <= tolerance. The record's first n samples (zero-phase: and its last n) are contaminated by
/// transients of that order, relative to what caused them.
/// @throws std::invalid_argument when tolerance is not between 0 and 1 or the filter is unstable.
Eigen::Index settling_samples(const CascadedFilter& filter, double tolerance = 1e-3);

/// Digital Butterworth filters of order n, with W = tan(pi f dt) / tan(pi corner dt):
///
///     low-pass  |H|^2 = 1 / (1 + W^(2n))      high-pass  |H|^2 = 1 / (1 + W^(-2n))
///
/// from the analogue prototype [butterworth1930], prewarped so that half the power passes at the corner
/// itself. A band-pass is the cascade of both.
/// @param corner_hz [Hz], between 0 and half the sampling rate
/// @param interval sampling interval [s]
/// @throws std::invalid_argument when order is not 1 to 8, or corner or interval are out of range.
CascadedFilter butterworth_low_pass(int order, double corner_hz, double interval);
CascadedFilter butterworth_high_pass(int order, double corner_hz, double interval);

}  // namespace beamid::experiments
