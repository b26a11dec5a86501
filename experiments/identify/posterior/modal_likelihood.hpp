// The likelihood of measured modes.
#pragma once

#include <vector>

#include "experiments/identify/posterior/likelihood.hpp"
#include "experiments/identify/posterior/prior_law.hpp"
#include "experiments/identify/update/modal_residual.hpp"

namespace beamid::experiments {

/// ln L = -1/2 sum r^2 - sum ln(sqrt(2 pi) s) over the rows of ModalResidual that are measurements. A shape
/// of p components counts as p - 1 numbers, the density of its direction: its scale says nothing.
class ModalLikelihood final : public Likelihood {
 public:
  /// @param residual outlives it
  explicit ModalLikelihood(const ModalResidual& residual);

  Eigen::Index size() const override { return static_cast<Eigen::Index>(priors_.size()); }
  LikelihoodValue at(const Eigen::VectorXd& u, bool slopes) const override;

  const std::vector<PriorLaw>& priors() const { return priors_; }
  Eigen::VectorXd physical(const Eigen::VectorXd& u) const;  ///< p (q)
  Eigen::VectorXd slope(const Eigen::VectorXd& u) const;     ///< dp/du (q)
  /// Absent outside the prior.
  std::optional<Eigen::VectorXd> place(const Eigen::VectorXd& values) const;
  /// The same; what lies outside, two standard deviations from the prior's median.
  Eigen::VectorXd nearest(const Eigen::VectorXd& values) const;

 private:
  const ModalResidual& residual_;
  std::vector<PriorLaw> priors_;
  double constant_ = 0.0;
};

}  // namespace beamid::experiments
