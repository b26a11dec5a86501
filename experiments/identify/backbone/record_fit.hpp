// One model fitted to all samples of a decay.
#pragma once

#include <string>

#include "experiments/identify/backbone/decay_samples.hpp"
#include "experiments/identify/backbone/force_inversion.hpp"

namespace beamid::experiments {

/// One model by maximum likelihood.
struct RecordFit {
  std::string name;  ///< "linear", "elastic", "masing", "between", "duffing", "bouc_wen"
  bool converged = false;
  std::string reason;
  Eigen::Index unknowns = 0;  ///< start, offset and parameters
  double log_likelihood = 0, bic = 0;
  double left = 0;            ///< rms of the residuals, relative to that of the samples
  Eigen::VectorXd residuals;  ///< (M)
  ForceLaw spring;            ///< of the first four, as are the following
  SecantCurve damping_curve{1.0, 1};
  Eigen::VectorXd damping;
  double masing = 0, masing_deviation = 0;  ///< mu of loop_motion.hpp
  double largest =
      0;  ///< argument up to which the motion asks F: displacement, or half a swing of the loop [m]
  Eigen::Vector2d motion = Eigen::Vector2d::Zero();  ///< [x, x'] at the first sample taken
  double offset = 0;
};

/// Status and residuals of an estimate with `steps` steps between two samples.
RecordFit record_fit(const std::string& name, const filters::BatchEstimate& found,
                     const DecaySamples& samples, int steps);

}  // namespace beamid::experiments
