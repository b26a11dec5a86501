#include "filters/filter.hpp"

namespace beamid::filters {

Gaussian Filter::marginal(const std::vector<Eigen::Index>& entries) const {
  const Gaussian& all = belief();
  if (all.covariance.size() > 0) return {all.mean(entries), all.covariance(entries, entries)};
  return {all.mean(entries), {}, all.factor(entries, Eigen::all)};
}

FilterRegistry& filter_registry() {
  static FilterRegistry registry("filter");
  return registry;
}

}  // namespace beamid::filters
