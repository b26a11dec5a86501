// Three storeys on a base that has moved for ever, as a sum of sines: exact, made by formulas of its own.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "experiments/record/record.hpp"

namespace beamid::test {

/// Masses of 1 kg, one damping ratio for each mode, absolute accelerations at 100 Hz of content to 25 Hz.
struct ShakenBuilding {
  double noise = 0.0;      ///< of the floors' readings [m/s2]
  double softening = 0.0;  ///< of all storeys in the second half of the record, as a share
  std::uint64_t seed = 5;
  Eigen::Vector3d damping = ratio();  ///< of the modes

  static Eigen::Vector3d stiffness() { return {2400.0, 3100.0, 3800.0}; }  ///< [N/m]
  static Eigen::Vector3d ratio() { return {0.012, 0.008, 0.005}; }
  static Eigen::Vector3d frequency_hz();

  /// Row 0 of the samples is the base's.
  experiments::Record record(Eigen::Index samples) const;
};

}  // namespace beamid::test
