// The test rig of the study, simulated on the continuum.
#pragma once

#include <cstdint>

#include "experiments/record/record.hpp"
#include "fem/beam.hpp"
#include "fem/free_decay.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments {

/// A cantilever pulled at the tip by a static force and released from rest; an accelerometer on the tip.
struct Release {
  fem::Beam beam;
  int elements = 80;
  int modes = 8;  ///< kept in the motion
  double first_damping_ratio = 0.002;
  double higher_damping_ratio = 0.005;  ///< of every mode above the first
  double tip_deflection = 0.012;        ///< [m]
  double duration = 25.0;               ///< [s]
  double sampling_rate = 1000.0;        ///< [Hz]
};

/// What the tip does, exactly, and which modes it is made of.
struct ReleasedBeam {
  Eigen::VectorXd time;              ///< (N) [s], from the release
  fem::Motion tip;                   ///< (N each)
  fem::Modes modes;                  ///< k modes
  Eigen::VectorXd modal_amplitudes;  ///< (k) at the tip [m]
};

/// Finite elements, modes, and exact modal superposition.
ReleasedBeam release(const Release& settings);

/// The tip's acceleration as an accelerometer with white noise of the given deviation [m/s2] records it.
Record measure_acceleration(const ReleasedBeam& beam, double noise, std::uint64_t seed, std::uint64_t stream);

}  // namespace beamid::experiments
