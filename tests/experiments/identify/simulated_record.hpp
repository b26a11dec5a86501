// Records whose stiffness and damping are known.
#pragma once

#include <numbers>

#include "experiments/identify/engine/record_identification.hpp"
#include "experiments/models/oscillator.hpp"
#include "experiments/signal/toolbox.hpp"
#include "fem/exact/exact_cantilever.hpp"
#include "fem/free_decay.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::test {

/// The steel beam with 0.36 kg at its tip, ringing in its first mode: 10 s at 200 Hz, 12 mm at first.
struct SimulatedBeam {
  fem::Cantilever beam = steel_beam(0.360490);
  double damping_ratio = 0.0045;
  fem::ExactMode mode{beam, 1};
  /// 33/140 m + tip mass with the exact frequency: K = Meq w^2, C = 2 xi w Meq.
  experiments::Oscillator truth = experiments::Oscillator::from_frequency(
      33.0 / 140.0 * beam.mass() + beam.tip_mass, mode.angular_frequency(), damping_ratio);

  /// The beam as its owner describes it: 10 % stiffer than it is, so that the frequency is 5 % off.
  experiments::Experiment experiment() const;

  /// Channels of the quantities with white noise of `relative_noise` times each one's amplitude.
  experiments::Record record(const std::vector<experiments::Quantity>& quantities, double relative_noise,
                             std::uint64_t seed) const;
};

}  // namespace beamid::test
