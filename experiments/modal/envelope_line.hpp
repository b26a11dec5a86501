// A straight line through the logarithm of a decaying analytic signal.
#pragma once

#include <Eigen/Core>
#include <complex>

namespace beamid::experiments {

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

}  // namespace beamid::experiments
