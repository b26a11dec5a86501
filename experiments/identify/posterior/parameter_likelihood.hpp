// A likelihood whose parameters have names, units and priors.
#pragma once

#include <optional>
#include <vector>

#include "experiments/identify/posterior/likelihood.hpp"
#include "experiments/identify/posterior/prior_law.hpp"

namespace beamid::experiments {

class ParameterLikelihood : public Likelihood {
 public:
  Eigen::Index size() const override { return static_cast<Eigen::Index>(priors_.size()); }
  const std::vector<PriorLaw>& priors() const { return priors_; }
  Eigen::VectorXd physical(const Eigen::VectorXd& u) const;  ///< p (q)
  Eigen::VectorXd slope(const Eigen::VectorXd& u) const;     ///< dp/du (q)
  /// Absent outside the prior.
  std::optional<Eigen::VectorXd> place(const Eigen::VectorXd& values) const;
  /// The same; what lies outside, two standard deviations from the prior's median.
  Eigen::VectorXd nearest(const Eigen::VectorXd& values) const;

 protected:
  std::vector<PriorLaw> priors_;  // filled by who inherits
};

}  // namespace beamid::experiments
