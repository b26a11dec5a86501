#include "tests/experiments/identify/simulated_record.hpp"

namespace beamid::test {

experiments::Experiment SimulatedBeam::experiment() const {
  experiments::Experiment experiment;
  fem::Cantilever assumed = beam;
  assumed.bending_stiffness *= 1.1;
  experiment.structure = fem::Beam(assumed);
  return experiment;
}

experiments::Record SimulatedBeam::record(const std::vector<experiments::Quantity>& quantities,
                                          double relative_noise, std::uint64_t seed) const {
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

}  // namespace beamid::test
