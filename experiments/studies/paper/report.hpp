// The study's outcome as tables, figures, words and numbers.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/models/oscillator.hpp"
#include "experiments/results/figure.hpp"
#include "experiments/results/results.hpp"
#include "experiments/results/table.hpp"
#include "experiments/studies/paper/monte_carlo.hpp"
#include "experiments/studies/paper/numerical_validation.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments::paper {

// What forward Euler predicts for the measured beams without any assumed damping ratio.

// The 2009 settings on a tip motion with higher modes: where the record starts decides what is found.

/// R = 1e-5, P0 of K and C 1e5, true noise-free displacement and velocity of the tip, filtered from a sample
/// on.
struct StartCase {
  Eigen::Index sample = 0;                                      ///< after the release
  double guess_over_truth = 0.8;                                ///< K0 / K
  Eigen::Index modes = 0;                                       ///< in the motion; 0: all
  double exact_error_percent = 0.0, euler_error_percent = 0.0;  ///< of C
  bool exact_lost = false, euler_lost = false;  ///< no damping left, or K 5 % off the first mode's
};

struct StartOutcome {
  std::string beam;
  double euler_prediction_percent = 0.0;  ///< closed form
  std::vector<StartCase> starts;          ///< the samples of the table
  std::vector<StartCase> guesses;         ///< K0 varied, from the release on
  std::vector<StartCase> counts;          ///< modes in the motion varied, from the release on
  std::vector<StartCase> curve;           ///< samples closely spaced
};
StartOutcome vary_start(const BeamCase& beam);

Table start_table(const StartOutcome& outcome);
Table guess_table(const StartOutcome& outcome);
Table mode_count_table(const StartOutcome& outcome);
Figure start_figure(const StartOutcome& outcome);

// What the innovations show of forward Euler: nothing on one channel, the ratio of two on two.
//
// The parameters found make the eigenvalue right and with it one history. The mode's shape (x, v) is then
// that of lambda_f and not of lambda, and |v|/|x| wrong by w dt / 2: seen where R is the sensors', hidden
// where R is large.

/// One released oscillator with noise on both channels, R that of the noise unless said, by two schemes.
struct ChannelCase {
  std::string motion;                                       ///< "table 2" or a beam
  std::string observed;                                     ///< "x" or "x and v"
  double displacement_noise = 0.0;                          ///< standard deviation [m]
  double velocity_noise = 0.0;                              ///< [m/s]
  double assumed_variance = 0.0;                            ///< R of both; 0: that of the noise
  double euler_square = 0.0, exact_square = 0.0;            ///< mean NIS over the outputs
  double euler_correlation = 0.0, exact_correlation = 0.0;  ///< of displacement's innovations, lag one
};

/// @param beam whose first mode is looked at beside the oscillator of table 2
std::vector<ChannelCase> examine_channels(const BeamCase& beam, std::uint64_t seed);

Table channel_table(const std::vector<ChannelCase>& cases);

/// Of one beam, in the limit of light damping, where lambda_f = (e^(i w dt) - 1)/dt: C_f - C = Meq w^2 dt and
/// xi_f - xi = w dt / 2, up to (w dt)^2/12 of themselves. Whoever holds the article's table 3 can refute it.
struct Prediction {
  std::string beam;
  double damping_difference = 0.0;           ///< C(filter) - C(modal analysis) [N s/m]
  double damping_ratio_difference = 0.0;     ///< xi(filter) - xi(modal analysis)
  double least_relative_error = 0.0;         ///< of C, if xi < light_damping
  double amplitude_after_four_cycles = 0.0;  ///< reproduced / measured, whatever xi is
  /// With the assumed damping ratio: share of the amplitude that four cycles take, measured and reproduced.
  double measured_drop = 0.0, reproduced_drop = 0.0;
};

inline constexpr double light_damping = 0.005;  ///< "all damping ratios are below 0.5 %" [inverse2009]

Prediction predict(const BeamCase& beam);

/// The numbers that depend on no assumption.
Table prediction_table(const std::vector<Prediction>& predictions);
/// What the eye compares in a plot: the drop over four cycles, with the assumed damping ratios.
Table fourth_cycle_table(const std::vector<Prediction>& predictions);
Figure prediction_figure(const std::vector<Prediction>& predictions);

// Errors as the study reports them: in per cent of a reference oscillator.

inline double stiffness_error(const Oscillator& found, const Oscillator& reference) {
  return percent(found.stiffness, reference.stiffness);
}

inline double damping_error(const Oscillator& found, const Oscillator& reference) {
  return percent(found.damping, reference.damping);
}

// Everything the paper's study finds, before it is put into words, tables and figures.

// The bias of forward Euler on the paper's oscillator against the covariances of its filter.
//
// On one channel and without process noise the filter ends where its innovations vanish, on g^-1 (e^(lambda
// dt)). On two channels it weighs two histories that one wrong model cannot both follow. With process noise
// on the motion it forgets the past and fits every single step instead, v+ = Phi_21 x + Phi_22 v, so that
//
//     K_f = -Phi_21 M / dt,   C_f = (1 - Phi_22) M / dt,   C_f - C = K dt (1 - 4 xi^2) / 2 + ...
//
// where Phi = e^(A dt) is the exact step: half of K dt.

/// What forward Euler finds that is fitted to single steps of an exact motion.
Oscillator seen_step_by_step(const Oscillator& truth, double interval);

/// The filter of table 2 with one covariance changed, after a release of 12 mm.
struct CovarianceCase {
  std::string varied;  ///< which one, with its unit
  double value = 0.0;
  double stiffness_error_percent = 0.0, damping_error_percent = 0.0;
};

struct CovarianceOutcome {
  std::vector<CovarianceCase> cases;      ///< R, Q and P0, a value each
  std::vector<CovarianceCase> curve;      ///< Q alone, closely spaced
  Oscillator truth, whole, step_by_step;  ///< truth, and both closed forms
};
CovarianceOutcome vary_covariances();

Table covariance_table(const CovarianceOutcome& outcome);
Figure covariance_figure(const CovarianceOutcome& outcome);

// Other causes that could have made C wrong, one at a time, before an exact filter.

/// What the exact filter makes of the five beams when one thing is done wrong to a clean first mode.
struct AlternativeCase {
  std::string name;
  Eigen::VectorXd damping_error_percent;        ///< without process noise (5)
  Eigen::VectorXd noisy_damping_error_percent;  ///< Q of the motion 1e-8 per step (5)
  Eigen::VectorXd stiffness_error_percent;      ///< without process noise (5)
};

inline constexpr double alternative_process_variance = 1e-8;

/// @param beams the five
std::vector<AlternativeCase> examine_alternatives(const std::vector<const BeamCase*>& beams);

Table alternative_table(const std::vector<AlternativeCase>& cases);

/// A filter and how it moves: the paper's own first, then what cures it.
struct Variant {
  const char* filter;
  const char* scheme;
  const char* label;
};
inline constexpr std::array<Variant, 4> variants{{{"ekf", "forward_euler", "EKF, forward Euler"},
                                                  {"ekf", "exponential", "EKF, exact"},
                                                  {"ukf", "forward_euler", "UKF, forward Euler"},
                                                  {"ukf", "exponential", "UKF, exact"}}};

/// One discretisation on the simulated oscillator.
struct SchemeOutcome {
  std::string scheme;
  Oscillator predicted;              ///< closed form
  Identification ekf, ukf;           ///< with the paper's own settings (table 2)
  Identification displacement_only;  ///< EKF, with noise so small that only the discretisation is left
};

/// One beam, measured, processed and identified.
struct BeamOutcome {
  BeamCase beam;
  BeamSettings settings;
  ReferenceAnalysis analysis;
  filters::Measurements motion;              ///< processed displacement and velocity
  std::array<Identification, 4> identified;  ///< by the variants
  std::array<Oscillator, 4> predicted;       ///< what the variants' schemes see of the reference
  /// Exact EKF with the paper's wide prior: on the true motion, after its own processing, after a zero-phase
  /// high-pass.
  Identification wide_true, wide_processed, wide_zero_phase;
  Identification wide_euler;  ///< forward Euler after the paper's own processing: the chain of 2009
  Identification zero_phase;  ///< exact EKF, tuned processing made zero-phase, both ends left out
  TrialStatistics trials;
};

struct Outcome {
  std::uint64_t seed = 0;
  Oscillator truth;  ///< of the simulated oscillator
  std::vector<SchemeOutcome> schemes;
  /// Forward Euler with the variance of K and C as printed, 10^-5, after a release of 12 mm and of 1 m.
  Identification literal_variance, literal_variance_large;
  std::vector<BeamOutcome> beams;
  std::vector<DigitCase> digits;        ///< how specific the published digits are
  CovarianceOutcome covariances;        ///< the bias against R, Q and P0
  std::vector<ChannelCase> channels;    ///< what the innovations show
  std::vector<Prediction> predictions;  ///< of the measured beams, nothing assumed
  std::vector<AlternativeCase> alternatives;
  StartOutcome start;  ///< S(0.65), the settings of 2009 and where the record starts
  StepOutcome step;    ///< S(11.8), the same record at longer steps
};

/// Runs it all. @param trials seeded repetitions per beam. @param progress is told what is being done.
Outcome investigate(std::uint64_t seed, int trials, const Progress& progress);

/// Modal analysis: tip mass, first frequency, damping ratio (its table 1).
Table table_1(const Outcome& outcome);
/// The simulated oscillator: published errors, ours, and the closed form (its table 2).
Table table_2(const Outcome& outcome);
/// Filter against closed form where nothing but the discretisation is left.
Table bias_table(const Outcome& outcome);
/// K, C and damping ratio of the beams (its table 3).
Table table_3(const Outcome& outcome);
/// K/M against w^2 (its table 4).
Table table_4(const Outcome& outcome);
/// Damping error against xi sqrt(Meq), with the law's prediction (its table 5).
Table table_5(const Outcome& outcome);
/// Wide prior and unmodelled modes: the second cause of failure.
Table second_cause_table(const Outcome& outcome);
/// Both schemes before the chain of 2009 and before the tuned one.
Table chain_table(const Outcome& outcome);
/// Zero-phase filtering, with its end transients left out and kept.
Table zero_phase_table(const Outcome& outcome);
/// Mean and rms error over the seeded trials against the Cramer-Rao bound.
Table trials_table(const Outcome& outcome);
/// Error of Rayleigh's equivalent mass.
Table reduction_table(const Outcome& outcome);

std::vector<Figure> figures(const Outcome& outcome);
Attachment mode_shapes(const Outcome& outcome);

/// Headings, paragraphs and tables in the order in which they are read.
void add_finding(const Outcome& outcome, Results& results);

/// The keys of results.json.
nlohmann::ordered_json values(const Outcome& outcome);
/// Those of what the argument rests on, beside the paper's own tables.
nlohmann::ordered_json argument_values(const Outcome& outcome);
nlohmann::ordered_json configuration(const Outcome& outcome);

}  // namespace beamid::experiments::paper
