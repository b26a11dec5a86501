// Forces nobody measured and places where nothing was: [[unknown_forces]], [[virtual_sensors]], [fatigue].
#pragma once

#include <optional>
#include <string>

#include "experiments/record/record.hpp"
#include "experiments/text/input_error.hpp"

namespace beamid::experiments {

/// A force that acted without being measured, as a random process (filters/latent_inputs.hpp).
struct UnknownForce {
  enum class Process { ornstein_uhlenbeck, matern, random_walk };
  std::string name = {};
  Quantity quantity = Quantity::force;  ///< or base_acceleration
  std::optional<double> position = {};  ///< of a force [m]; absent: the natural point
  std::string at = {};                  ///< in its place, of a structure whose places have names
  Process process = Process::matern;
  std::optional<double> deviation = {};         ///< [N or m/s2]; absent: from the record
  std::optional<double> correlation_time = {};  ///< [s]; absent: from the record, 1 of a random walk
  Place place = {};                             ///< of the table, for messages
};

/// What would be measured where nothing was.
struct VirtualSensor {
  std::string name = {};
  Quantity quantity = Quantity::displacement;
  bool bending_moment = false;          ///< M = E I w'': read as the strain of a fibre at c = -E I
  std::optional<double> position = {};  ///< [m]; absent: the natural point
  double distance = 0.0;                ///< strain: of the surface from the axis, c of -c w'' [m]
  std::string at = {};
};

/// Cycles N of a strain range r to failure: N = cycles (strain_range / r)^exponent [basquin1910].
struct FatigueLaw {
  double exponent = 5.0;
  double strain_range = 0.0;
  double cycles = 2e6;
};

}  // namespace beamid::experiments
