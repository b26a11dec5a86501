// [identifiability] of an experiment file.
#pragma once

namespace beamid::experiments {

/// What `beamid identifiability` assumes of the test and tries out.
struct IdentifiabilitySettings {
  bool force_measured = true;  ///< false: the record begins when the force has ended
  int places = 40;             ///< along the beam, to which a sensor is moved, at most
  int more_sensors = 5;        ///< added one by one to those described
};

}  // namespace beamid::experiments
