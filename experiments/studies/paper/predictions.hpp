// What forward Euler predicts for the measured beams without any assumed damping ratio.
#pragma once

#include <string>
#include <vector>

#include "experiments/results/figure.hpp"
#include "experiments/results/table.hpp"
#include "experiments/studies/paper/beam_identification.hpp"

namespace beamid::experiments::paper {

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
