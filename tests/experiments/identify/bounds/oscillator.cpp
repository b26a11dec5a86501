#include "tests/experiments/identify/bounds/oscillator.hpp"

namespace beamid::test {

using namespace experiments;

std::vector<filters::Label> FreeOscillator::state_labels() const {
  return {
      {"displacement", "m"}, {"velocity", "m/s"}, {"stiffness", "N/m"}, {"damping", "N s/m"}, {"mass", "kg"}};
}

void FreeOscillator::motion_matrix(const Eigen::VectorXd& z, Eigen::MatrixXd& matrix) const {
  matrix.resize(2, 2);
  matrix << 0.0, 1.0, -z[2] / z[4], -z[3] / z[4];
}

void FreeOscillator::motion_matrix_derivative(const Eigen::VectorXd& z, Eigen::Index j,
                                              Eigen::MatrixXd& matrix) const {
  matrix.setZero(2, 2);
  if (j < 2) matrix(1, j) = -1.0 / z[4];
  if (j == 2) matrix.row(1) << z[2] / (z[4] * z[4]), z[3] / (z[4] * z[4]);
}

void FreeOscillator::input_matrix(const Eigen::VectorXd& z, Eigen::MatrixXd& matrix) const {
  matrix.setZero(2, input_size());
  if (forced_) matrix(1, 0) = 1.0 / z[4];
}

void FreeOscillator::input_matrix_derivative(const Eigen::VectorXd& z, Eigen::Index j,
                                             Eigen::MatrixXd& matrix) const {
  matrix.setZero(2, input_size());
  if (forced_ && j == 2) matrix(1, 0) = -1.0 / (z[4] * z[4]);
}

void FreeOscillator::output(const Eigen::VectorXd& z, const Eigen::VectorXd& f, Eigen::VectorXd& y) const {
  y = Eigen::VectorXd::Constant(1, ((forced_ ? f[0] : 0.0) - z[2] * z[0] - z[3] * z[1]) / z[4]);
}

ObservedMotion oscillating(double mass, double frequency_hz, double ratio, double displacement,
                           double interval, int unknowns, bool forced) {
  const double omega = 2.0 * M_PI * frequency_hz;
  const double values[] = {mass * omega * omega, 2.0 * ratio * omega * mass, mass};
  const char* const names[] = {"stiffness", "damping", "mass"};
  const char* const units[] = {"N/m", "N s/m", "kg"};
  ObservedMotion motion;
  motion.model.motion = std::make_shared<FreeOscillator>(forced);
  for (int j = 0; j < unknowns; ++j) {
    motion.model.unknowns.push_back({names[j], units[j], values[j], 0.3 * values[j]});
    motion.model.unknown_places.push_back(2 + j);
  }
  motion.model.mode_shapes = Eigen::MatrixXd::Ones(1, 1);
  motion.model.mode_frequencies = Eigen::VectorXd::Constant(1, omega);
  motion.initial_state.resize(5);
  motion.initial_state << displacement, 0.0, values[0], values[1], values[2];
  motion.directions =
      start_directions(motion.model, {{Quantity::acceleration}}, {std::max(displacement, 1e-3), 1.0});
  motion.interval = interval;
  return motion;
}

Eigen::VectorXd bounds_of(const ObservedMotion& motion, Eigen::Index samples, double noise) {
  const ChannelInformation record = channel_information(motion, {{samples, 1}}).front();
  return relative_bounds(information_about_unknowns(motion, record, {{0, noise}}));
}

}  // namespace beamid::test
