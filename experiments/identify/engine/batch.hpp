// The yardstick: all samples at once, by the model that the filter has.
#pragma once

#include <optional>
#include <vector>

#include "experiments/models/estimates.hpp"
#include "experiments/models/identification.hpp"
#include "filters/batch_estimator.hpp"

namespace beamid::experiments {

/// What all samples at once show.
struct BatchIdentification {
  filters::BatchEstimate estimate;
  std::vector<Estimate> parameters;              ///< empty unless the record determines all
  std::optional<Identification> identification;  ///< of one degree of freedom, without a run; likewise
};

/// Output-error maximum likelihood (filters::estimate_batch) of initial motion, unknowns and offsets, without
/// a prior. Its noise and its discretisation are the filter's.
/// @param start of the motion nearest to the record, with the unknowns that the filter started from (n)
/// @param directions in which it is free (n x r)
BatchIdentification identify_batch(const JointModel& model, const IdentificationSettings& settings,
                                   const Eigen::VectorXd& start, const Eigen::MatrixXd& directions,
                                   const filters::Measurements& measured);

}  // namespace beamid::experiments
