// Whether all channels of a free decay ring at the same frequencies.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/modal/joint_decay_fit.hpp"

namespace beamid::experiments {

/// A structure has one frequency for each mode, wherever it is measured: channels whose own frequencies, one
/// Gauss-Newton step from the joint ones, scatter by more than their deviations have clocks of their own.
struct ClockScatter {
  double chi_square = 0.0, freedom = 0.0;  ///< of the channels' frequencies about those of their modes
  Eigen::VectorXd farthest;  ///< of each mode, how far the farthest of its channels surely is (K) [rad/s]
  Eigen::Index fast = 0, slow = 0;      ///< the clocks furthest apart, of the channels (p)
  double apart = 0.0, deviation = 0.0;  ///< by how much, relative

  /// "The channels do not ring at one frequency ...: tip runs 100 ppm faster than mid, ...".
  std::string sentence(const std::vector<std::string>& channels) const;
};

/// Absent where they agree: chi^2 below its 0.01 % point.
std::optional<ClockScatter> clock_scatter(const JointDecayFit& fit);

}  // namespace beamid::experiments
