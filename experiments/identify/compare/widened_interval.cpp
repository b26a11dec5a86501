#include "experiments/identify/compare/widened_interval.hpp"

#include <cmath>

namespace beamid::experiments {

void set_interval(ComparedRun& run, std::size_t j, double spread) {
  const Unknown& unknown = run.unknowns[j];
  const auto place = static_cast<Eigen::Index>(j);
  const double mean = run.unknown_state.mean[place];
  const double half = quantile_95 * spread * std::sqrt(run.unknown_state.covariance(place, place));
  run.parameters[j].estimate.lower_95 = unknown.to_physical(mean - half);
  run.parameters[j].estimate.upper_95 = unknown.to_physical(mean + half);
}

}  // namespace beamid::experiments
