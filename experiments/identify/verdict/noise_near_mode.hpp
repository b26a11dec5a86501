// How dense the noise of a free decay is where it matters: at the mode's frequency.
#pragma once

#include <complex>

#include <Eigen/Core>

#include "experiments/modal/dominant_mode.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {

// What one mode and an offset leave of a record.

/// The motion of one mode and an offset, and the residual.
struct ModeResidual {
  Eigen::MatrixXd reproduced;          ///< the nearest motion, of every sample (p x N)
  Eigen::VectorXd standard_deviation;  ///< of what it leaves of the samples that were measured (p)
};

/// y_i(t) = Re(a_i e^(rate t)) + b_i by linear least squares, channel by channel (fit_shapes); samples that
/// are NaN are left out.
/// @param samples (p x N) @param time of the stamps, even or not (N) [s]
ModeResidual mode_residual(const Eigen::MatrixXd& samples, const Eigen::VectorXd& time,
                           std::complex<double> rate);

/// A channel with the motion in place of what is NaN (N).
Eigen::VectorXd with_mode_in_gaps(const Eigen::VectorXd& signal, double interval, std::complex<double> rate);

/// The noise of a signal around the frequency of a mode.
struct NoiseNearMode {
  double deviation = 0;  ///< of white noise as dense as what is left at the mode [unit of the signal]
  double freedom = 0;    ///< degrees of freedom of its square
  double slope = 0;      ///< d log(density) / d log(frequency) there: 0 white, -1 for 1/f
  int lines = 0;         ///< of the periodogram that it rests on

  double student() const { return student_factor(freedom); }
};

/// The density S(f) of what the mode leaves of a signal (N), at its frequency f, by Whittle's
/// likelihood [whittle1953] of its periodogram P_k = |E_k|^2 / n, decimated to 8 samples per cycle:
///
///     log S_k = a + b log(f_k / f),   f / 1.6 <= f_k <= 1.6 f
///     -L(a, b) = sum_k w_k log S_k + P_k / S_k + b^2 / 8,        w_k = 1 - sum_j |Q_jk|^2 / n
///
/// S(f) = e^a, less its bias to first order [cordeiro1991]; freedom 2 / var a with (-L'')^-1 = cov(a, b). Q
/// is an orthonormal basis of what the fit of amplitude, phase, frequency, damping and offset takes out of
/// the noise, 1 - w_k the share of line k that goes with it. A companion mode is not taken out: to a filter
/// of one mode it is noise. b^2 / 8 leaves slopes beyond +-4 hardly likely, which few lines could not tell.
/// The band grows upwards until the w_k sum to 2. Samples that are NaN were not measured: the mode takes
/// their place, and what they would have left of the noise is added in proportion.
///
/// What weighs on frequency and damping is the density within a line or two of f, where light damping
/// concentrates the response: the band's mean is another where the density falls through it.
/// @throws as decimate() does.
NoiseNearMode noise_near_mode(const Eigen::VectorXd& signal, double interval, const ModalEstimate& modal);

}  // namespace beamid::experiments
