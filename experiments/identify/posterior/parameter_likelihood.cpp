#include "experiments/identify/posterior/parameter_likelihood.hpp"

#include <algorithm>

namespace beamid::experiments {

using Eigen::Index, Eigen::VectorXd;

VectorXd ParameterLikelihood::physical(const VectorXd& u) const {
  VectorXd values(size());
  for (Index j = 0; j < size(); ++j) values[j] = priors_[static_cast<std::size_t>(j)].value(u[j]);
  return values;
}

VectorXd ParameterLikelihood::slope(const VectorXd& u) const {
  VectorXd slopes(size());
  for (Index j = 0; j < size(); ++j) slopes[j] = priors_[static_cast<std::size_t>(j)].slope(u[j]);
  return slopes;
}

std::optional<VectorXd> ParameterLikelihood::place(const VectorXd& values) const {
  VectorXd u(size());
  for (Index j = 0; j < size(); ++j) {
    const std::optional<double> one = priors_[static_cast<std::size_t>(j)].place(values[j]);
    if (!one) return {};
    u[j] = *one;
  }
  return u;
}

VectorXd ParameterLikelihood::nearest(const VectorXd& values) const {
  VectorXd u(size());
  for (Index j = 0; j < size(); ++j) {
    const PriorLaw& prior = priors_[static_cast<std::size_t>(j)];
    u[j] = std::clamp(prior.place(values[j]).value_or(values[j] > prior.value(0.0) ? 2.0 : -2.0), -4.0, 4.0);
  }
  return u;
}

}  // namespace beamid::experiments
