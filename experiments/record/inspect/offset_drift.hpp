// An offset that wanders through a record, or settles at its start.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace beamid::experiments {

struct OffsetDrift {
  double from = 0, to = 0;   ///< lowest and highest mean [unit of the signal]
  bool start_up = false;     ///< all of it at the beginning: an amplifier that settles
  Eigen::Index settled = 0;  ///< sample from which on it stays, where it is a start-up
};

/// Means of up to twenty parts of the signal, whole periods and two at least, between which the offset goes
/// by more than a quarter of the signal's largest deviation and ten times what noise does to such a mean.
/// Nothing where five parts do not fit.
/// @param period of the vibration [samples]; 0: none. @param noise standard deviation
std::optional<OffsetDrift> offset_drift(const Eigen::VectorXd& signal, double period, double noise);

}  // namespace beamid::experiments
