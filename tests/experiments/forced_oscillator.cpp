#include "tests/experiments/forced_oscillator.hpp"

namespace beamid::test {

experiments::Record driven_throughout(const experiments::Oscillator& oscillator, double duration, double rate,
                                      double noise, std::uint64_t seed) {
  using Eigen::Index;
  const auto count = static_cast<Index>(duration * rate) + 1;
  const double dt = 1 / rate;
  const Eigen::VectorXd white = experiments::standard_normal(count + 2, seed, 0);
  const Eigen::VectorXd force = (white.head(count) + white.segment(1, count) + white.tail(count)) / 3;
  Eigen::Matrix4d motion = Eigen::Matrix4d::Zero();
  motion(0, 1) = 1;
  motion.row(1) << -oscillator.stiffness, -oscillator.damping, 1, 0;
  motion.row(1) /= oscillator.mass;
  motion(2, 3) = 1;
  const Eigen::Matrix4d step = (motion * dt).exp();
  experiments::Record record;
  record.time = Eigen::VectorXd::LinSpaced(count, 0, dt * static_cast<double>(count - 1));
  record.channels = {{experiments::Quantity::acceleration, "tip"}, {experiments::Quantity::force, "force"}};
  record.samples.resize(2, count);
  Eigen::Vector4d state = Eigen::Vector4d::Zero();
  for (Index k = 0; k < count; ++k) {
    state[2] = force[k];
    state[3] = k + 1 < count ? (force[k + 1] - force[k]) / dt : 0.0;
    record.samples.col(k) << motion.row(1).dot(state), force[k];
    state = step * state;
  }
  const double size = record.samples.row(0).norm() / std::sqrt(static_cast<double>(count));
  record.samples.row(0) += noise * size * experiments::standard_normal(count, seed, 1).transpose();
  return record;
}

}  // namespace beamid::test
