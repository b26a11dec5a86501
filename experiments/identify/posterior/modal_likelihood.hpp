// The likelihood of measured modes.
#pragma once

#include "experiments/identify/posterior/parameter_likelihood.hpp"
#include "experiments/identify/update/modal_residual.hpp"

namespace beamid::experiments {

/// ln L = -1/2 sum r^2 - sum ln(sqrt(2 pi) s) over the rows of ModalResidual that are measurements. A shape
/// of p components counts as p - 1 numbers, the density of its direction: its scale says nothing.
class ModalLikelihood final : public ParameterLikelihood {
 public:
  /// @param residual outlives it
  explicit ModalLikelihood(const ModalResidual& residual);

  LikelihoodValue at(const Eigen::VectorXd& u, bool slopes) const override;

 private:
  const ModalResidual& residual_;
  double constant_ = 0.0;
};

}  // namespace beamid::experiments
