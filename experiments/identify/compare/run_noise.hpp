// The noise that a run of the engine assumes, and the one that its bound is worked out with.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/identify/analysis.hpp"

namespace beamid::experiments {

struct ComparedRecord;

/// What is certain of the noise of the outputs.
struct KnownNoise {
  Eigen::VectorXd configured;   ///< 0: not configured (p)
  Eigen::VectorXd least;        ///< the sensors' own, or what double precision asks for (p)
  std::vector<bool> is_stated;  ///< in the experiment file, rather than taken from the record (p)
};
KnownNoise known_noise(const Experiment& experiment, const RecordAnalysis& analysis,
                       const ComparedRecord& compared);

/// Of a channel, as stated of it or in [noise] of its quantity; 0: not stated.
double stated_noise(const Experiment& experiment, const Channel& channel);

/// Standard deviations of the inputs, as stated of their channels or in [noise]; 0: exact (m).
Eigen::VectorXd input_noise(const Experiment& experiment, const Record& record);

/// What is configured, else what a motion leaves of the record (p).
Eigen::VectorXd assumed_noise(const KnownNoise& known, const Eigen::VectorXd& left);

/// Of a simulated record its sensors' own, or what the best motion leaves where that is more than chance; of
/// another record what the filter assumes (p).
Eigen::VectorXd noise_of_bound(const ComparedRecord& compared, const KnownNoise& known,
                               const Eigen::VectorXd& left, const Eigen::VectorXd& assumed);

/// R that weighs channels by their size, before anything is known of their noise (p x p).
Eigen::MatrixXd unit_noise(const Eigen::MatrixXd& outputs);

}  // namespace beamid::experiments
