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

double overconfidence(double deviation, double bound, double prior_deviation) {
  constexpr double clearly = 0.8;
  const double least = 1.0 / std::hypot(1.0 / bound, 1.0 / prior_deviation), part = deviation / least;
  return part < clearly ? part : 1.0;
}

}  // namespace beamid::experiments
