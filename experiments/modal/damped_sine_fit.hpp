// Damped sines by nonlinear least squares.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace beamid::experiments {

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

}  // namespace beamid::experiments
