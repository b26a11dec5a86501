#include "experiments/models/estimates.hpp"

#include <cmath>

namespace beamid::experiments {

using Eigen::Index, Eigen::VectorXd;

std::vector<Estimate> estimates(const JointModel& model, const filters::Gaussian& estimate) {
  std::vector<Estimate> result;
  for (std::size_t j = 0; j < model.unknowns.size(); ++j) {
    const Unknown& unknown = model.unknowns[j];
    const Index place = model.unknown_places[j];
    const double mean = estimate.mean[place], deviation = std::sqrt(estimate.marginal(place, 1)(0, 0));
    result.push_back({unknown.name, unknown.unit, unknown.to_physical(mean),
                      std::abs(unknown.slope(mean)) * deviation,
                      unknown.to_physical(mean - quantile_95 * deviation),
                      unknown.to_physical(mean + quantile_95 * deviation), unknown.guess, unknown.deviation,
                      unknown.nuisance});
  }
  return result;
}

VectorXd unknown_values(const JointModel& model, const VectorXd& state) {
  VectorXd values(static_cast<Index>(model.unknowns.size()));
  for (Index j = 0; j < values.size(); ++j)
    values[j] = model.unknowns[j].to_physical(state[model.unknown_places[j]]);
  return values;
}

}  // namespace beamid::experiments
