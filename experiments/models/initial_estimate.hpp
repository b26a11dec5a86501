// What is assumed before the record is seen.
#pragma once

#include "experiments/models/joint_model.hpp"
#include "filters/gaussian.hpp"

namespace beamid::experiments {

/// How large the motion and the sensors' offsets may be.
struct StartScale {
  double displacement = 0.0;  ///< of the first mode, at the output where it is largest [m]
  double duration = 0.0;      ///< of the record [s]; a drift may add up to as much as a bias over it
};

/// From the largest reading of every channel, as a motion of the model's first mode would give it.
/// @param samples (p x N), observed as the observations say.
StartScale start_scale(const JointModel& model, const std::vector<Observation>& observations,
                       const Eigen::MatrixXd& samples, double duration);

/// The directions in which the initial state is uncertain, a column each: displacement and velocity of every
/// mode of the model, then the sensors' offsets, slips by as much
/// as the first mode, then the unknowns.
///
/// Mode i moves by up to `displacement` omega_1 / omega_i, which leaves all modes the same velocity: a blow
/// excites them so, a release the higher ones less.
struct StartDirections {
  Eigen::MatrixXd motion;    ///< (n x (2k + offsets + slips))
  Eigen::MatrixXd unknowns;  ///< (n x q)

  Eigen::MatrixXd all() const;  ///< side by side
};
StartDirections start_directions(const JointModel& model, const std::vector<Observation>& observations,
                                 const StartScale& scale);

/// At rest, the unknowns at their guesses; uncertain in the start directions. The covariance itself is formed
/// for small states only.
filters::Gaussian initial_estimate(const JointModel& model, const StartDirections& directions);

}  // namespace beamid::experiments
