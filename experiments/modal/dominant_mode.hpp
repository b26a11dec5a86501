// The reference modal analysis: frequency and damping ratio of the mode that dominates a free decay.
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "experiments/modal/subspace_realisation.hpp"

namespace beamid::experiments {

// Damped sines by nonlinear least squares.

/// Re(amplitude e^(rate t)), with t = 0 at the first sample.
struct DampedSine {
  std::complex<double> rate;       ///< -damping rate + i damped angular frequency [rad/s]
  std::complex<double> amplitude;  ///< [unit of the signal]
};

/// y(t) = offset + the sum of K damped sines.
struct DampedSineFit {
  std::vector<DampedSine> sines;  ///< K
  double offset = 0;              ///< [unit of the signal]
  /// (J^T J)^-1 (4K+1 x 4K+1), in the order damped angular frequency, damping rate, Re and Im amplitude of
  /// each sine, offset: times the variance of white noise, the covariance of the estimates.
  Eigen::MatrixXd cofactors;
  Eigen::VectorXd residuals;  ///< (N); 0 where nothing was measured
  double residual_standard_deviation = 0;
};

/// Least squares over a signal (N) by Gauss-Newton steps with exact derivatives, damped where they do not
/// descend (Levenberg-Marquardt [marquardt1963]). For white noise it reaches the Cramer-Rao bound. Samples
/// that are NaN were not measured, and are left out.
/// @param start K rates, each right to about one cycle over the signal; amplitudes and offset follow from
/// them
/// @throws std::invalid_argument with fewer than 2 (4K+1) samples, or a rate that does not oscillate.
/// @throws std::runtime_error when it does not converge.
DampedSineFit fit_damped_sines(const Eigen::VectorXd& signal, double interval,
                               const std::vector<std::complex<double>>& start);

/// How the strongest mode of a record is looked for.
struct ModalAnalysisSettings {
  std::optional<double> expected_frequency_hz;  ///< absent: the peak of the spectrum
  double frequency_tolerance = 0.25;            ///< how far the mode may lie from it, relative
  double samples_per_cycle = 8;                 ///< left by the decimation
  double companion_amplitude = 0.1;  ///< relative; weaker modes beside the dominant one are not fitted along
  EigensystemSettings eigensystem;
};

/// Another mode, so near in frequency that it was fitted along with the dominant one.
struct CompanionMode {
  double frequency_hz = 0;
  double damping_ratio = 0;
  double amplitude = 0;  ///< [unit of the signal]

  std::complex<double> rate() const;  ///< as ModalEstimate::rate()
};

/// y(t) = offset + amplitude e^(-damping_ratio w t) cos(w_d t + phase), with w = 2 pi frequency_hz,
/// w_d = w sqrt(1 - damping_ratio^2) and t = 0 at the first sample.
struct ModalEstimate {
  double frequency_hz = 0;  ///< undamped
  double damping_ratio = 0;
  double frequency_standard_deviation_hz = 0;
  double damping_ratio_standard_deviation = 0;
  double amplitude = 0;  ///< [unit of the signal]
  double phase = 0;      ///< [rad]
  double offset = 0;
  double residual_standard_deviation = 0;  ///< of the undecimated signal, modes not fitted included
  double noise_standard_deviation = 0;  ///< of white noise as dense as the residual near the mode's frequency
  double realised_frequency_hz = 0;     ///< by the eigensystem realisation, before least squares
  double realised_damping_ratio = 0;
  std::vector<CompanionMode> companions;

  /// s = w (-damping_ratio + i sqrt(1 - damping_ratio^2)) [rad/s].
  std::complex<double> rate() const;
};

/// Modal analysis of a free decay (N): decimate, realise the eigensystem, choose the mode, and polish it by
/// nonlinear least squares.
///
/// The mode is the strongest within frequency_tolerance of the expected frequency. Modes between half and
/// twice its frequency would bias it over a few cycles: those that the realisation resolves (further away
/// than 1.5 cycles over the signal) are fitted along. Poles nearer than that are one mode whose frequency
/// varies; the order is lowered until one is left.
///
/// The least squares see the decimated signal, which modes above 0.7 samples_per_cycle times the frequency do
/// not reach. In the undecimated signal a higher mode as strong as this one shifts the damping ratio by ten
/// per cent and more over a few time constants. White noise stays white below the decimation's edge, so that
/// only the kernel's half length at each end is lost; frequency and damping are those of the undecimated
/// signal, to which amplitude and phase are returned.
///
/// Samples that are NaN were not measured (a clipped sensor, a gap): the least squares are those of the
/// others. Companions with which the least squares do not converge are left out.
///
/// Standard deviations are those for white noise as dense as the decimated residual. They know nothing of a
/// damping that varies with amplitude.
/// @throws std::invalid_argument when the signal is too short or shows no mode there (found ones are named).
/// @throws std::runtime_error when the least squares do not converge, even of one sine.
ModalEstimate dominant_mode(const Eigen::VectorXd& signal, double interval,
                            const ModalAnalysisSettings& settings = {});

}  // namespace beamid::experiments
