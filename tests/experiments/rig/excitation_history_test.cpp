// Oracles: conservation of momentum; the static deflection of a cantilever, x^2 (3 L - x) / (2 L^3) of its
// tip's.
#include "experiments/rig/virtual_rig.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/text/input_error.hpp"
#include "fem/assembly.hpp"
#include "fem/beam.hpp"

namespace beamid::experiments::excitation_history_test {
namespace {

using Kind = Excitation::Kind;

fem::StructuralSystem system_of(const fem::Beam& beam) {
  return fem::assemble(beam, 10, {{"tip", beam.length()}});
}

const fem::Beam cantilever = fem::Cantilever{1.0, 100.0, 2.0};
const fem::TimeGrid grid{1e-3, 101, {}};

TEST(Release, StartsInTheStaticShape) {
  Excitation release;
  release.deflection = 0.02;
  const auto system = system_of(cantilever);
  const auto motion = excite(release, system, 0, grid, "");
  const Eigen::VectorXd w = fem::nodal_deflection(system, motion.loading.initial_displacement);
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    const double x = system.mesh.nodes[i].x;
    EXPECT_NEAR(w[i], 0.02 * x * x * (3 - x) / 2, 1e-15);
  }
  EXPECT_EQ(motion.loading.initial_velocity.size(), 0);
}

// A free beam takes up the whole momentum: r^T M v = p, r the rigid translation.
TEST(Impulse, CarriesItsMomentumAtOnce) {
  fem::Beam free = cantilever;
  free.supports.clear();
  const auto system = system_of(free);
  Excitation impulse;
  impulse.kind = Kind::impulse;
  impulse.momentum = 3.0;
  const auto motion = excite(impulse, system, 0, grid, "");
  const double momentum = -motion.loading.initial_velocity.dot(Eigen::VectorXd(system.inputs.col(1)));
  EXPECT_NEAR(momentum, 3.0, 1e-12);
}

TEST(Impulse, CarriesItsMomentumInHalfASine) {
  Excitation impulse;
  impulse.kind = Kind::impulse;
  impulse.momentum = 3.0;
  for (const double duration : {0.004, 0.0057, 0.03}) {
    impulse.duration = duration;
    const auto motion = excite(impulse, system_of(cantilever), 0, grid, "");
    EXPECT_NEAR(motion.loading.inputs.row(0).sum() * grid.interval, 3.0, 1e-12);  // straight lines in between
    EXPECT_NEAR(motion.loading.inputs.row(0).maxCoeff() / (3.0 * M_PI / (2 * duration)), 1.0, 0.12);
  }
  impulse.duration = 0.0039;
  EXPECT_THROW(excite(impulse, system_of(cantilever), 0, grid, ""), InputError);
}

TEST(Harmonic, SaysWhenStepsAreTooLong) {
  Excitation harmonic;
  harmonic.kind = Kind::harmonic;
  harmonic.amplitude = 2.0;
  harmonic.frequency_hz = 10.0;
  const auto fine = excite(harmonic, system_of(cantilever), 0, grid, "");
  EXPECT_TRUE(fine.notes.empty());
  EXPECT_NEAR(fine.loading.inputs(0, 25), 2.0, 1e-14);  // a quarter of a period
  harmonic.frequency_hz = 100.0;
  EXPECT_EQ(excite(harmonic, system_of(cantilever), 0, grid, "").notes.size(), 1u);
}

TEST(Base, MovesTheLastInput) {
  Excitation base;
  base.kind = Kind::base;
  base.amplitude = 2.0;
  base.frequency_hz = 10.0;
  const auto motion = excite(base, system_of(cantilever), 0, grid, "");
  EXPECT_EQ(motion.loading.inputs.row(0).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(motion.loading.inputs.row(1).transpose(), motion.base_acceleration);
}

TEST(Free, StartsInOneMode) {
  Excitation free;
  free.kind = Kind::free;
  free.velocity = 0.5;
  free.mode = 2;
  const auto system = system_of(cantilever);
  const auto motion = excite(free, system, 0, grid, "");
  EXPECT_NEAR(motion.loading.initial_displacement.norm(), 0.0, 0.0);
  EXPECT_NEAR((system.outputs * motion.loading.initial_velocity)(0), 0.5, 1e-12);
}

TEST(Release, NeedsAStaticShape) {
  fem::Beam free = cantilever;
  free.supports.clear();
  Excitation release;
  release.place = {"a.toml", 3, 1};
  try {
    excite(release, system_of(free), 0, grid, "");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.line(), 3u) << error.what();
  }
}

}  // namespace
}  // namespace beamid::experiments::excitation_history_test
