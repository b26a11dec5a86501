// Whether a driven record is likelier with one of its clocks late.
#pragma once

#include <optional>

#include "experiments/identify/clocks/clock_step.hpp"

namespace beamid::experiments {

/// One clock that may be late, of those of a record whose inputs were measured.
struct LikeliestLag {
  std::optional<Eigen::Index> output;  ///< that is late to the inputs (of p); absent: all of them
  ClockStep step;                      ///< with this lag alone

  double lag() const { return step.lag[0]; }  ///< behind the inputs [s]
  /// Of the lag, with the noise that is left where it is taken out [s].
  double deviation() const;
};

/// Of all outputs together and of each alone, what leaves least of the record where its lag is unknown too
/// (clock_step.hpp); absent where none is determined. Arguments as clock_information().
std::optional<LikeliestLag> likeliest_lag(filters::DiscreteModel& discrete,
                                          const Eigen::VectorXd& initial_state,
                                          const StartDirections& directions,
                                          const filters::Measurements& record,
                                          const Eigen::MatrixXd& outputs);

}  // namespace beamid::experiments
