// All modes of a free decay in all its channels, by nonlinear least squares.
#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

namespace beamid::experiments {

/// e^(rate t) at t = 0, dt, ..., (N - 1) dt: an exponential for one sample of 64, a product for the others.
Eigen::VectorXcd decaying_wave(std::complex<double> rate, double interval, Eigen::Index count);

/// y_i(t) = offset_i + sum_m Re(shape_im e^(rate_m t)), t = 0 at the first sample.
struct JointDecayFit {
  std::vector<std::complex<double>> rates;      ///< K [rad/s]
  Eigen::MatrixXcd shapes;                      ///< (p x K) [unit of the outputs]
  Eigen::VectorXd offsets;                      ///< (p)
  Eigen::MatrixXd reconstruction;               ///< (p x N)
  Eigen::VectorXd residual_standard_deviation;  ///< (p)
  Eigen::MatrixXd noise_variance;  ///< (p x K) of white noise as dense as the residual near each mode
  /// (p x K) by what each channel alone would change the damped angular frequencies, one Gauss-Newton step
  /// for each mode, and the deviation of that, infinite where it does not show the mode [rad/s].
  Eigen::MatrixXd own_shift, own_shift_deviation;
  /// (2K x 2K) of damped angular frequency and damping rate of each mode [rad/s], for noise as dense as the
  /// residual is near each mode's frequency. That rests on few lines: by the factor that makes 1.96
  /// deviations the 95 % point of Student's distribution.
  Eigen::MatrixXd covariance;
};

/// Damped sines with the same rates in p channels, each with its own noise level: maximum likelihood by
/// Newton's steps (damped where they do not descend) on the rates alone, on mean and squared half difference
/// of those of close modes; amplitudes and offsets are eliminated by variable projection [golub1973]. For p =
/// 1 it is fit_damped_sines.
/// @param outputs (p x N), one column per instant
/// @param start K rates, each right to about one cycle over the record
/// @throws std::invalid_argument with fewer than 2 (4K+1) samples, or a rate that does not oscillate.
/// @throws std::runtime_error when it does not converge.
JointDecayFit fit_decays_jointly(const Eigen::MatrixXd& outputs, double interval,
                                 const std::vector<std::complex<double>>& start);

}  // namespace beamid::experiments
