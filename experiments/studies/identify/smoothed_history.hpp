// What the whole record says of every instant, as a file and a picture.
#pragma once

#include "experiments/models/joint_model.hpp"
#include "experiments/results/results.hpp"
#include "filters/gaussian.hpp"

namespace beamid::experiments {

/// What a filter and a smoother made of a record.
struct SmoothedRecord {
  const Eigen::VectorXd& time;  ///< of the samples (N) [s]
  const JointModel& model;
  const std::vector<filters::Gaussian>& filtered;  ///< (N)
  const std::vector<filters::Gaussian>& smoothed;  ///< (N)
};

/// smoothed.csv: time_s, then mean and standard deviation of every state at every sample.
Attachment smoothed_history(const SmoothedRecord& record);

/// The first coordinate over six cycles of the frequency, up to three unknowns over the record: the filter's
/// and the smoother's, with bands of 95 %.
Figure smoothed_figure(const SmoothedRecord& record, double frequency_hz);

}  // namespace beamid::experiments
