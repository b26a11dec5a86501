// The likelihood of a record: that of a Kalman filter's innovations.
#pragma once

#include <vector>

#include "experiments/identify/posterior/parameter_likelihood.hpp"
#include "experiments/identify/sensing/sensing_model.hpp"

namespace beamid::experiments {

/// ln p(record | p), the motion integrated out exactly (filters/innovation_likelihood.hpp): of the parameters
/// of a structure and of what else is not known, the sizes of unknown forces and of the sensors' noise, whose
/// priors are lognormal about the guess with a deviation of SensingModel::known_within.
class RecordLikelihood final : public ParameterLikelihood {
 public:
  /// @param model outlives it
  RecordLikelihood(const SensingModel& model, const Experiment& experiment);

  LikelihoodValue at(const Eigen::VectorXd& u, bool slopes) const override;

  const std::vector<Unknown>& unknowns() const { return unknowns_; }  ///< (q)

 private:
  const SensingModel& model_;
  filters::InnovationProblem problem_;
  std::vector<Unknown> unknowns_;
  double constant_ = 0.0;
};

}  // namespace beamid::experiments
