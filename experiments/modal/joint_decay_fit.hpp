// All modes of a free decay in all its channels, by nonlinear least squares.
#pragma once

#include <complex>
#include <optional>
#include <string>
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
  /// residual is near each mode's frequency.
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

// Whether all channels of a free decay ring at the same frequencies.

/// A structure has one frequency for each mode, wherever it is measured: channels whose own frequencies, one
/// Gauss-Newton step from the joint ones, scatter by more than their deviations have clocks of their own.
struct ClockScatter {
  double chi_square = 0.0, freedom = 0.0;  ///< of the channels' frequencies about those of their modes
  Eigen::VectorXd farthest;  ///< of each mode, how far the farthest of its channels surely is (K) [rad/s]
  Eigen::Index fast = 0, slow = 0;      ///< the clocks furthest apart, of the channels (p)
  double apart = 0.0, deviation = 0.0;  ///< by how much, relative

  /// "The channels do not ring at one frequency ...: tip runs 100 ppm faster than mid, ...".
  std::string sentence(const std::vector<std::string>& channels) const;
};

/// Absent where they agree: chi^2 below its 1e-6 point, as the noise near each mode is itself estimated from
/// few lines.
std::optional<ClockScatter> clock_scatter(const JointDecayFit& fit);

}  // namespace beamid::experiments
