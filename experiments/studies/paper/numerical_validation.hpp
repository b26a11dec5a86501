// The paper's own test of its filter: a simulated oscillator, noise-free (its table 2, its figures 2 and 3).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "experiments/models/identification.hpp"
#include "experiments/models/oscillator.hpp"
#include "experiments/results/figure.hpp"
#include "experiments/results/table.hpp"
#include "experiments/studies/paper/monte_carlo.hpp"

namespace beamid::experiments::paper {

// How specific the published digits are: which data, filter and observed channels print 0.13 % and 6.41 %.

// The experiment that decides on any record: the same record at longer and longer steps.

/// Every n-th sample of one processed record, identified by both schemes.
struct StepCase {
  double interval = 0.0;                          ///< [s]
  double exact_ratio = 0.0, euler_ratio = 0.0;    ///< damping ratios found
  double predicted_ratio = 0.0;                   ///< forward Euler's, from what the exact scheme found
  double exact_square = 0.0, euler_square = 0.0;  ///< mean NIS
};

struct StepOutcome {
  std::string beam;
  std::vector<StepCase> steps;
  double extrapolated_ratio = 0.0;  ///< forward Euler's at dt = 0, by the polynomial through all steps
  std::vector<StepCase> curve;      ///< predicted_ratio over closely spaced intervals
};

/// @param motion displacement and velocity, low-passed so that what is left out aliases nothing
StepOutcome vary_step(const BeamCase& beam, const filters::Measurements& motion,
                      const BeamSettings& settings);

Table step_table(const StepOutcome& outcome);
Figure step_figure(const StepOutcome& outcome);

/// One combination on the paper's oscillator, with the settings of table 2 and a release of 12 mm.
struct DigitCase {
  std::string data;      ///< generator of the record (numerical_validation.hpp)
  std::string scheme;    ///< the filter's discretisation
  std::string observed;  ///< "x and v", "x" or "v"
  double stiffness_error_percent = 0.0, damping_error_percent = 0.0;

  /// Whether its errors, without signs, are the published ones to the last digit printed.
  bool prints_the_published_digits() const;
};

/// Every generator with every compared scheme and the three choices of what is observed.
std::vector<DigitCase> examine_digits();

/// Error of C of all of them, and those that print the published digits.
Table digit_matrix(const std::vector<DigitCase>& cases);
Table digit_matches(const std::vector<DigitCase>& cases);
Figure digit_figure(const std::vector<DigitCase>& cases);

// Records of a free decay as a data generator of 2009 might have made them: exact, or by a time step of its
// own.

/// The generators compared: exact motion, three of Newmark's family [newmark1959], and the one-step schemes.
const std::vector<std::string>& data_generators();

/// Displacement and velocity (2 x samples) of an oscillator released from rest, the first sample one interval
/// after the release.
/// @param generator "exact"; "average_acceleration", "linear_acceleration" or "central_difference", Newmark's
///   beta = 1/4, 1/6 or 0; or the name of a registered scheme.
/// @throws std::invalid_argument for another name.
Eigen::MatrixXd generate_decay(const std::string& generator, const Oscillator& truth, double release,
                               double interval, Eigen::Index samples);

/// M = 3.0 kg, K = 515.8 N/m, damping ratio 10 %, sampled every millisecond [inverse2009].
inline constexpr double validation_interval = 1e-3;  // [s]
Oscillator validation_truth();

inline constexpr double published_stiffness_error_percent = 0.13;  // as printed, without sign
inline constexpr double published_damping_error_percent = 6.41;

/// The schemes compared, the paper's first.
const std::vector<std::string>& compared_schemes();

/// A simulated free decay and the filter that reads it.
struct ValidationSettings {
  std::vector<Quantity> observed{Quantity::displacement, Quantity::velocity};
  double release = 1.0;  ///< initial displacement [m]; the paper does not print it
  double duration = 5.0;
  double noise_variance = 1e-5;                      ///< R, as the paper
  double velocity_variance = 0.0;                    ///< R of velocity where it differs; 0: as of the other
  double process_variance = 0.0;                     ///< Q of displacement and velocity, per step
  Eigen::Vector4d initial_variance{1, 1, 1e5, 1e5};  ///< P0: the paper prints 10^-5 for K and C
  double first_stiffness = 300.0, first_damping = 2.0;
  int passes = 1;
  Oscillator truth = validation_truth();
  double interval = validation_interval;  ///< [s]
  std::string data = "exact";             ///< what makes the record (numerical_validation.hpp)
  /// Standard deviations of the noise on displacement [m] and on velocity [m/s], and its seed.
  Eigen::Vector2d sensor_noise = Eigen::Vector2d::Zero();
  std::uint64_t seed = 2009;
};

/// The filter's K and C, and its history when kept. The first sample used is one interval after the release.
Identification validate(const std::string& filter, const std::string& scheme,
                        const ValidationSettings& settings,
                        filters::Keep keep = filters::Keep::last_estimate);

/// Settings under which neither prior nor linearisation leaves a trace: displacement alone, R = 1e-12, two
/// passes.
ValidationSettings bias_settings();

}  // namespace beamid::experiments::paper
