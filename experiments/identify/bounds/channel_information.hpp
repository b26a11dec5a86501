// What each sensor tells by itself, over one pass through a model's motion.
#pragma once

#include <string>
#include <vector>

#include "experiments/models/initial_estimate.hpp"
#include "experiments/models/joint_model.hpp"
#include "filters/information_factor.hpp"

namespace beamid::experiments {

/// A motion of a model, about which sensors are asked.
struct ObservedMotion {
  JointModel model;
  Eigen::VectorXd initial_state;  ///< (n), the unknowns in their places
  StartDirections directions;
  Eigen::MatrixXd inputs =
      {};                 ///< u_k in its columns, as a discrete model takes them (m (d + 1) x N); empty: none
  double interval = 0.0;  ///< between samples [s]
  std::string discretisation = "exponential";
};

/// A record: the first `samples` of the motion, every `stride`-th of them read.
struct Reading {
  Eigen::Index samples = 0;
  Eigen::Index stride = 1;
};

/// Fisher information of every channel about [start (2k), unknowns (q)], in units of the directions, were its
/// noise 1 [unit of the channel] per sample. What a channel's own bias and drift may imitate is taken off.
///
/// White noises that do not depend on each other: the information of some channels together is the sum of
/// theirs, each divided by its variance.
struct ChannelInformation {
  Eigen::Index start = 0;                            ///< 2k
  std::vector<filters::InformationFactor> channels;  ///< p
};

/// One for each reading, from a single pass over the longest of them.
/// @throws std::invalid_argument when a reading has no sample or no stride, or the inputs end too early;
/// std::runtime_error when the motion or its sensitivities do not remain finite.
std::vector<ChannelInformation> channel_information(const ObservedMotion& motion,
                                                    const std::vector<Reading>& readings);

}  // namespace beamid::experiments
