// One model fitted to all samples of a decay.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/identify/backbone/amplitude_windows.hpp"
#include "experiments/identify/backbone/secant_curve.hpp"
#include "experiments/record/record.hpp"
#include "filters/batch_estimator.hpp"

namespace beamid::experiments {

// The samples of a free decay as output-error fits take them.

/// Samples as they are, and at the fine steps that the registered models take, NaN between.
struct DecaySamples {
  filters::Measurements plain, fine;
  double lost = 0;       ///< before the first of them [s]
  double whiteness = 1;  ///< what the low-pass takes from the variance of white noise
  int steps = 1;         ///< fine steps between two samples
  int factor = 1;        ///< of the decimation
  double frequency_hz = 0;
  Quantity quantity = Quantity::acceleration;

  double interval() const { return plain.time[1] - plain.time[0]; }
  Eigen::Index size() const { return plain.time.size(); }
  double peak() const { return plain.outputs.cwiseAbs().maxCoeff(); }

  /// Settings of an estimate from samples with `steps` steps between them.
  /// @param grow whether to begin with the first cycles
  /// @param most passes for each length
  filters::BatchSettings batch_settings(int steps, bool grow, int most) const;
};

/// Of a signal (N), low-passed to `samples_per_period` of the frequency where it has four times as many; 48
/// fine steps in a period at least.
DecaySamples decay_samples(const Eigen::VectorXd& signal, double interval, Quantity quantity,
                           double frequency_hz, double samples_per_period);

// From stiffness and damping by amplitude to the force law: the describing function inverted.

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

/// One model by maximum likelihood.
struct RecordFit {
  std::string name;  ///< "linear", "elastic", "masing", "between", "duffing", "bouc_wen"
  bool converged = false;
  std::string reason;
  Eigen::Index unknowns = 0;  ///< start, offset and parameters
  double log_likelihood = 0, bic = 0;
  double left = 0;            ///< rms of the residuals, relative to that of the samples
  Eigen::VectorXd residuals;  ///< (M)
  ForceLaw spring;            ///< of the first four, as are the following
  SecantCurve damping_curve{1.0, 1};
  Eigen::VectorXd damping;
  double masing = 0, masing_deviation = 0;  ///< mu of loop_motion.hpp
  double largest =
      0;  ///< argument up to which the motion asks F: displacement, or half a swing of the loop [m]
  Eigen::Vector2d motion = Eigen::Vector2d::Zero();  ///< [x, x'] at the first sample taken
  double offset = 0;
};

/// Status and residuals of an estimate with `steps` steps between two samples.
RecordFit record_fit(const std::string& name, const filters::BatchEstimate& found,
                     const DecaySamples& samples, int steps);

// A registered model of one coordinate fitted to all samples of a decay.

/// Quantities of a model with the values that its fit begins with, stiffness and damping first.
using ModelStart = std::vector<std::pair<std::string, double>>;

/// By filters::estimate_batch in the fine steps of the samples (Runge-Kutta), from several starts of its
/// unknowns; the best of them.
/// @param noise standard deviation of a sample
/// @param motion [x, x'] at the first sample, the beginning of each
RecordFit registered_fit(const std::string& name, const DecaySamples& samples, double mass, double noise,
                         const Eigen::Vector2d& motion, double offset, const std::vector<ModelStart>& starts);

}  // namespace beamid::experiments
