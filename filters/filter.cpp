#include "filters/filter.hpp"

#include <cmath>
#include <limits>

namespace beamid::filters {

const Correction& Filter::correct(const Eigen::VectorXd& output, const Eigen::VectorXd& input) {
  if (output.allFinite()) {
    model_.observe_all();
    take_in(output, input);
    return correction_;
  }
  std::vector<Eigen::Index> measured;
  for (Eigen::Index i = 0; i < output.size(); ++i)
    if (!std::isnan(output[i])) measured.push_back(i);
  measured_ = output(measured);
  if (!measured_.allFinite())
    throw FilterFailure("a measurement is infinite", std::numeric_limits<double>::quiet_NaN());
  model_.observe(std::move(measured));
  if (measured_.size() > 0)
    take_in(measured_, input);
  else
    correction_ = {};
  return correction_;
}

Gaussian Filter::marginal(const std::vector<Eigen::Index>& entries) const {
  const Gaussian& all = estimate();
  if (all.covariance.size() > 0) return {all.mean(entries), all.covariance(entries, entries)};
  return {all.mean(entries), {}, all.factor(entries, Eigen::all)};
}

FilterRegistry& filter_registry() {
  static FilterRegistry registry("filter");
  return registry;
}

}  // namespace beamid::filters
