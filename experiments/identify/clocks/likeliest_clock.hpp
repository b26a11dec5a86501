// Whether a record is likelier with one of its clocks late, or at another rate.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "experiments/models/joint_model.hpp"
#include "experiments/record/record.hpp"
#include "filters/discrete_model.hpp"
#include "filters/measurements.hpp"

namespace beamid::experiments {

// Channels whose stamps are by another clock than the others'.

/// One such channel. What it showed at t it stamped t + lag.
struct OwnClock {
  Eigen::Index channel = 0;           ///< of the record
  bool input = false;                 ///< a measured force or motion of the base
  std::vector<Eigen::Index> outputs;  ///< that depend on the lag: its own, or all of an input (of p)
  double lag = 0.0;                   ///< behind the others, as found [s]
  double deviation = 0.0;             ///< of the lag, unknown parameters and start allowed for [s]
};

/// Those that the record names.
/// @throws std::invalid_argument when it has no such channel, its stamps are not even, no channel of motion
/// keeps the common clock, or one of several inputs does not.
std::vector<OwnClock> own_clocks(const Record& record);

/// Every such channel earlier by its lag, NaN where it was not read; where an input was not, the record is
/// shorter.
/// @throws std::invalid_argument when fewer than 16 samples remain.
Record with_common_clock(const Record& as_read, const std::vector<OwnClock>& clocks);

/// How far `read` lags behind `made`, where their correlation over all rows, each of unit size, is largest;
/// up to a quarter of the record [s]. Missing samples (NaN) count as none.
///
/// Whitened wholly, every frequency counts alike, and resonances that the model has elsewhere cost nothing;
/// not at all, the resonances count, where noise counts least [knapp1976].
/// @param read (p x N), @param made (p x N) at an interval [s]
/// @param whitened w of a cross spectrum over its magnitude to the power w, 0 to 1
double lag_by_correlation(const Eigen::MatrixXd& read, const Eigen::MatrixXd& made, double interval,
                          double whitened);

// The lags of single channels from the residual of a run.

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
/// (fisher_information.hpp),
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

/// One clock that may not be that of the others.
struct LikeliestClock {
  std::optional<Eigen::Index> output;  ///< whose it is (of p); absent: of all of them, beside the inputs'
  ClockStep step;                      ///< with this lag alone, or with it and its growth

  double lag() const { return step.lag[0]; }     ///< behind the rest, at the first sample [s]
  double growth() const { return step.lag[1]; }  ///< of the lag, of a clock at another rate [s / s]
  /// Of the lag [s] and of its growth, with the noise that is left where they are taken out.
  double lag_deviation() const { return deviation(0); }
  double growth_deviation() const { return deviation(1); }

 private:
  double deviation(Eigen::Index i) const;
};

/// The clock that leaves least, of either kind.
struct LikeliestClocks {
  std::optional<LikeliestClock> late;      ///< by a constant lag
  std::optional<LikeliestClock> drifting;  ///< by a lag that grows
};

/// What leaves least of the record where its lag is unknown too (likeliest_clock.hpp), of each output alone
/// where there are several, and of all together where inputs were measured; absent where none is determined.
/// Arguments as clock_information().
LikeliestClocks likeliest_clocks(filters::DiscreteModel& discrete, const Eigen::VectorXd& initial_state,
                                 const StartDirections& directions, const filters::Measurements& record,
                                 const Eigen::MatrixXd& outputs);

}  // namespace beamid::experiments
