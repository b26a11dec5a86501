// Whether a record is likelier with one of its clocks late, or at another rate.
#pragma once

#include <optional>

#include "experiments/identify/clocks/clock_step.hpp"

namespace beamid::experiments {

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

/// What leaves least of the record where its lag is unknown too (clock_step.hpp), of each output alone where
/// there are several, and of all together where inputs were measured; absent where none is determined.
/// Arguments as clock_information().
LikeliestClocks likeliest_clocks(filters::DiscreteModel& discrete, const Eigen::VectorXd& initial_state,
                                 const StartDirections& directions, const filters::Measurements& record,
                                 const Eigen::MatrixXd& outputs);

}  // namespace beamid::experiments
