// What forward Euler predicts for the measured beams without any assumed damping ratio.
#pragma once

#include <string>
#include <vector>

#include "experiments/results/figure.hpp"
#include "experiments/results/table.hpp"
#include "experiments/studies/paper/monte_carlo.hpp"

namespace beamid::experiments::paper {

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

}  // namespace beamid::experiments::paper
