// Records whose stiffness and damping are known.
#pragma once

#include <numbers>

#include "experiments/oscillator.hpp"
#include "experiments/random.hpp"
#include "experiments/record_identification/record_identification.hpp"
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

  /// The beam as its owner believes it to be: 10 % stiffer than it is, so that the frequency is 5 % off.
  experiments::Experiment experiment() const {
    experiments::Experiment experiment;
    fem::Cantilever believed = beam;
    believed.bending_stiffness *= 1.1;
    experiment.beam = believed;
    return experiment;
  }

  /// Channels of the quantities with white noise of `relative_noise` times each one's amplitude.
  experiments::Record record(const std::vector<experiments::Quantity>& quantities, double relative_noise,
                             std::uint64_t seed) const {
    using experiments::Quantity, Eigen::VectorXd;
    constexpr Eigen::Index samples = 2001;
    const auto one = [](double value) { return VectorXd::Constant(1, value); };
    const double w = mode.angular_frequency(), amplitude = 0.012;
    experiments::Record record;
    record.time = VectorXd::LinSpaced(samples, 0.0, 10.0);
    record.samples.resize(static_cast<Eigen::Index>(quantities.size()), samples);
    const fem::Motion motion = fem::free_decay(one(amplitude), one(w), one(damping_ratio), record.time);
    for (Eigen::Index i = 0; i < record.samples.rows(); ++i) {
      const Quantity quantity = quantities[i];
      const auto& [history, scale] =
          quantity == Quantity::displacement ? std::pair{motion.displacement, amplitude}
          : quantity == Quantity::velocity   ? std::pair{motion.velocity, amplitude * w}
                                             : std::pair{motion.acceleration, amplitude * w * w};
      record.samples.row(i) =
          history +
          relative_noise * scale * experiments::standard_normal(samples, seed, static_cast<std::uint64_t>(i));
      record.channels.push_back({quantity, "tip"});
    }
    return record;
  }
};

}  // namespace beamid::test
