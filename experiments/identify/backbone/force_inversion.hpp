// From stiffness and damping by amplitude to the force law: the describing function inverted.
#pragma once

#include "experiments/identify/backbone/amplitude_windows.hpp"
#include "experiments/identify/backbone/secant_curve.hpp"

namespace beamid::experiments {

/// A force law with its covariance.
struct ForceLaw {
  SecantCurve curve{1.0, 1};
  Eigen::VectorXd coefficients;  ///< theta (q)
  Eigen::MatrixXd covariance;    ///< (q x q)
  double chi_square = 0, freedom = 0;

  double secant(double x) const { return curve.shape(x).dot(coefficients); }
  double secant_deviation(double x) const;
  double force(double x) const { return x * secant(x); }
};

/// How the windows' stiffnesses are read.
enum class WindowReading {
  secant,   ///< K(A) itself, as a curve: what is naively taken for F(A) / A
  elastic,  ///< the describing function of an elastic spring, then its exact period
  masing    ///< the describing function of Masing's loop
};

/// theta by weighted least squares of K_i = sum_j w_ij K_eq(A_ij) over the windows; as many terms as make
/// BIC least, at most a term for every two windows. Deviations grow by sqrt(chi^2 / freedom) above one.
/// For `elastic`, where amplitudes are those of first harmonics, K_i is then multiplied by K_eq over M
/// omega^2 of the exact motion with that first harmonic on the spring found, and fitted again, three times.
/// @param least_terms where a change is asked for, 2
ForceLaw invert_windows(const std::vector<AmplitudeWindow>& windows, double range, WindowReading reading,
                        Eigen::Index least_terms = 1);

/// The amplitude, its largest displacement, of the motion whose first harmonic is this one.
double amplitude_of_harmonic(const ForceLaw& law, double first_harmonic);

}  // namespace beamid::experiments
