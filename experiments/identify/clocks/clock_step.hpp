// The lags of single channels from the residual of a run.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/identify/clocks/own_clock.hpp"
#include "experiments/models/initial_estimate.hpp"
#include "filters/discrete_model.hpp"
#include "filters/measurements.hpp"

namespace beamid::experiments {

/// One step of Gauss and Newton in the lags, the start and the unknowns together.
struct ClockStep {
  Eigen::VectorXd lag, deviation;  ///< that is left in the record, and how well it is known (g) [s]
  Eigen::VectorXd
      widening;           ///< of the unknowns' deviations, for the lags are not known either (q); 1 at least
  Eigen::VectorXd shift;  ///< of the unknowns where the lags are taken out, in their deviations (q)
  double left_share = 1.0;  ///< of the squares that are left without the step, what is left with it
};

/// What a record says of the unknowns (q), of the lags of clocks (g) and of what is left of it (1), the start
/// unknown: W^T W of the rows W = [S, Y', r] ((q + g + 1) x as many).
///
/// About the motion y(t) of the model that starts at `initial_state`: a channel of lag tau shows y(t - tau),
/// so that what is left of it falls along -y'(t); an input of lag tau makes all motion so much earlier to
/// others, +y'(t). With the sensitivities S of the start and the unknowns, by orthogonal factors
/// (information_factor.hpp),
///
///     min | L^-1 (y_read - y - S c + sum_g s_g y'_g tau_g) |^2 + |c_unknowns|^2,   R = L L^T, s = 1, inputs
///     -1
///
/// What is known of the unknowns counts as much as the directions are long.
/// @param outputs (p x N) of that motion; missing readings (NaN) count for nothing
/// @param grow behind the lags (g) also their growth (g), of a clock at another rate: -(t - t_0) y'(t)
Eigen::MatrixXd clock_information(filters::DiscreteModel& discrete, const Eigen::VectorXd& initial_state,
                                  const StartDirections& directions, const filters::Measurements& record,
                                  const Eigen::MatrixXd& outputs, const std::vector<OwnClock>& clocks,
                                  bool grow = false);

/// @param clocks g, whose lags stand behind the unknowns
/// @throws std::runtime_error when a channel with a clock of its own does not move.
ClockStep clock_step(const Eigen::MatrixXd& information, Eigen::Index clocks);

}  // namespace beamid::experiments
