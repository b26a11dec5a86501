// A decay whose frequency and damping follow its amplitude, fitted as one motion.
#pragma once

#include <Eigen/Core>

namespace beamid::experiments {

/// value + slope (g - pivot): slope and value at the pivot are uncorrelated.
struct LawLine {
  double value = 0, slope = 0, pivot = 0;
  double slope_deviation = 0;

  double at(double g) const { return value + slope * (g - pivot); }
};

/// With which amplitude it follows: g(A) = (A / A0)^power, or log(A / A0) for power 0.
struct AmplitudeShape {
  double power = 1;
  double log_reference = 0;  ///< log A0

  double at(double log_amplitude) const;
};

/// Where the iteration starts: straight lines over g, and the amplitude at the first sample.
struct AmplitudeLawStart {
  double frequency_hz = 0, frequency_slope = 0;
  double damping_ratio = 0, damping_slope = 0;
  double log_amplitude = 0;
};

struct AmplitudeLaw {
  LawLine frequency_hz, damping_ratio;
  double squares = 0, freedom = 0;  ///< of the residuals
  Eigen::VectorXd shape;            ///< g at the instants asked for
};

/// Least squares of
///
///     y = offset + Re z,    z' = (s0 + s1 g(|z|)) z,    s = -damping rate + i damped angular frequency
///
/// over a signal (N). It knows the phase from one end to the other, where fits of n sections know it within
/// each: its slopes are up to n times as sure. Gauss-Newton steps, g(|z(t)|) taken from the step before;
/// deviations are those for white noise.
/// @param instants after the first sample, rising; below 0 z is continued backwards [s]
/// @throws std::runtime_error when it does not converge.
AmplitudeLaw fit_amplitude_law(const Eigen::VectorXd& signal, double interval, const AmplitudeShape& shape,
                               const AmplitudeLawStart& start, const Eigen::VectorXd& instants);

}  // namespace beamid::experiments
