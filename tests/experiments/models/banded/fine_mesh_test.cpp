// A mesh of a thousand elements in bands. Oracle: closed forms of its first mode.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "experiments/models/banded/continuum_motion.hpp"
#include "fem/modes.hpp"
#include "tests/experiments/models/banded/banded_cases.hpp"

namespace beamid::experiments::fine_mesh_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

// A thousand elements in their first mode, undamped, nothing unknown.
struct FineMesh {
  BandedCase given;
  fem::Modes modes;
  VectorXd state;
  double turn = 0.0;  // the angle by which the step R(i omega dt) turns the mode
};

FineMesh fine_mesh() {
  FineMesh mesh{
      {"fine", fem::assemble_parametric(banded_beam(), 1000, {{"tip", 1.10}}, {}), {}}, {}, {}, 0.0};
  mesh.given.description.observations = {{Quantity::acceleration}};
  const fem::StructuralSystem& system = mesh.given.equations.system;
  mesh.modes = fem::modes(system, 1);
  mesh.state.setZero(2 * system.size());
  mesh.state.head(system.size()) = 0.01 * mesh.modes.shape.col(0);
  const std::complex<double> z(0.0, mesh.modes.angular_frequency[0] * banded_interval);
  mesh.turn = std::arg((12.0 + 6.0 * z + z * z) / (12.0 - 6.0 * z + z * z));
  return mesh;
}

TEST(ContinuumMotion, FineMeshKeepsTheFrequencyAndTheEnergy) {
  // Oracle: R(i omega dt) in closed form for the exact frequency of the mesh. Assembled stiffness is wrong by
  // 5e-8 here, and damps with a ratio of 3e-7.
  FineMesh mesh = fine_mesh();
  const Index n = mesh.given.equations.system.size();
  const auto model =
      discretise(std::make_shared<ContinuumMotion>(mesh.given.equations, mesh.given.description),
                 banded_interval, "pade", quiet_sensors(mesh.given));
  VectorXd next;
  const int steps = 1000;
  for (int k = 0; k < steps; ++k) {
    model->transition(mesh.state, {}, next);
    mesh.state.swap(next);
  }
  const VectorXd momentum = mesh.given.equations.system.mass * mesh.modes.shape.col(0) / 0.01;
  const double cosine = momentum.dot(mesh.state.head(n));
  const double sine = -momentum.dot(mesh.state.segment(n, n)) / mesh.modes.angular_frequency[0];
  EXPECT_NEAR(std::hypot(cosine, sine), 1.0, 1e-11);
  EXPECT_NEAR(std::remainder(std::atan2(sine, cosine) - steps * mesh.turn, 2.0 * std::numbers::pi), 0.0,
              1e-11);
}

TEST(ContinuumMotion, FineMeshReadsAccelerationsWithoutTheNoiseOfItsHighestModes) {
  // Oracle: -omega^2 q of the mode. Without smoothing rounding brings up to 1e-4 m/s2 here, and 1 m/s2 at a
  // tip without mass.
  FineMesh mesh = fine_mesh();
  const auto model =
      discretise(std::make_shared<ContinuumMotion>(mesh.given.equations, mesh.given.description),
                 banded_interval, "pade", quiet_sensors(mesh.given));
  const double omega = mesh.modes.angular_frequency[0];
  const double tip = 0.01 * (mesh.given.equations.system.outputs * mesh.modes.shape.col(0))[0];
  VectorXd next, read;
  for (int k = 0; k < 500; ++k) {
    model->output(mesh.state, {}, read);
    EXPECT_NEAR(read[0], -omega * omega * tip * std::cos(k * mesh.turn), 1e-7) << k;
    model->transition(mesh.state, {}, next);
    mesh.state.swap(next);
  }
}

TEST(ContinuumMotion, RefusesAFineMeshWhoseExponentialIsDense) {
  const FineMesh mesh = fine_mesh();
  const auto fine = std::make_shared<ContinuumMotion>(mesh.given.equations, mesh.given.description);
  EXPECT_THAT([&] { discretise(fine, banded_interval, "exponential", quiet_sensors(mesh.given)); },
              testing::ThrowsMessage<std::exception>(testing::HasSubstr(
                  "2000 coordinates; expected 'pade', or the reduction modal_truncation")));
}

}  // namespace
}  // namespace beamid::experiments::fine_mesh_test
