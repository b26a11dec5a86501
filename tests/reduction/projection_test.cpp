// The projection itself, whatever shapes it is given.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "fem/stiffness_solver.hpp"
#include "reduction/reduction.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::projection_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using reduction::reduction_registry;

fem::Beam free_beam() {
  fem::Beam beam = test::steel_beam(0.0);
  beam.supports.clear();
  return beam;
}

TEST(Projection, RefusesDependentShapes) {
  const auto system = assemble(test::steel_beam(0.0), 3);
  MatrixXd twice(6, 2);
  twice << static_shape(system), 2.0 * static_shape(system);
  EXPECT_THROW(reduction::project(system, {twice}), std::invalid_argument);
  EXPECT_THROW(reduction::project(system, {MatrixXd::Identity(5, 2)}), std::invalid_argument);
  EXPECT_THROW(reduction::project(system, {MatrixXd::Zero(6, 1)}), std::invalid_argument);
  EXPECT_THROW(reduction::project(system, {MatrixXd(6, 0)}), std::invalid_argument);
  twice(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(reduction::project(system, {twice}), std::invalid_argument);
}

TEST(Projection, OnTheIdentityIsTheSystemItself) {
  // Oracle: nothing is computed; a dense matrix of this size would take 3.2 GB.
  const auto system = assemble(test::steel_beam(0.0), 10000);
  const auto model = reduce(system, *reduction_registry().make("none", {}));
  EXPECT_TRUE(model.identity);
  EXPECT_EQ(model.shapes.size(), 0);
  EXPECT_EQ(model.system.size(), 20000);
  EXPECT_EQ(model.system.mesh.nodes.size(), 10001u);
  const VectorXd z = VectorXd::LinSpaced(20000, 0.0, 1.0);
  EXPECT_EQ((model.lift(z) - z).norm(), 0.0);
}

TEST(Projection, LiftsManyMotionsAtOnceRealAndComplex) {
  const auto system = assemble(test::steel_beam(0.0), 5);
  const auto model = reduce(system, *reduction_registry().make("modal_truncation", {{"modes", 2.0}}));
  EXPECT_FALSE(model.identity);
  const MatrixXd z = MatrixXd::Identity(2, 2);
  EXPECT_EQ((model.lift(z) - model.shapes).norm(), 0.0);
  const Eigen::VectorXcd turned = std::complex<double>(0.0, 1.0) * Eigen::VectorXcd::Ones(2);
  EXPECT_EQ((model.lift(turned).imag() - model.shapes.rowwise().sum()).norm(), 0.0);
}

TEST(Projection, KeepsTheModesOfAFreeBeam) {
  // Oracle: beta L = 4.730040744862704, 7.853204624095838, 10.995607838001671 [blevins1979].
  const double root[] = {4.730040744862704, 7.853204624095838, 10.995607838001671};
  const fem::Cantilever beam = test::steel_beam(0.0);
  const auto system = assemble(free_beam(), 60);
  const auto model = reduce(system, *reduction_registry().make("modal_truncation", {{"modes", 5.0}}));
  const fem::Modes modes = fem::modes(model.system, 5);
  EXPECT_EQ(modes.rigid, 2);
  for (int i = 0; i < 3; ++i) {
    const double exact =
        std::pow(root[i] / beam.length, 2) * std::sqrt(beam.bending_stiffness / beam.mass_per_length);
    EXPECT_NEAR(modes.angular_frequency[i + 2] / exact, 1.0, 2e-6);
  }
}

TEST(Projection, DoesNotDependOnHowTheShapesAreMixed) {
  // Oracle: frequencies belong to the span of the shapes. Each mixed shape has some rigid-body motion.
  const auto system = assemble(free_beam(), 30);
  const fem::Modes full = fem::modes(system, 6);
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  const MatrixXd mix = MatrixXd::NullaryExpr(6, 6, [&] { return normal(random); });
  const auto model = reduction::project(system, {full.shape * mix});
  const fem::Modes mixed = fem::modes(model.system, 6);
  EXPECT_EQ(mixed.rigid, 2);
  for (Index i = 2; i < 6; ++i)
    EXPECT_NEAR(mixed.angular_frequency[i] / full.angular_frequency[i], 1.0, 1e-10);
}

TEST(Projection, KeepsARigidMotionAlone) {
  // Oracle: a free body, M = m and no stiffness.
  const auto system = assemble(free_beam(), 10);
  VectorXd lift = VectorXd::Zero(system.size());
  for (Index i = 0; i < system.size(); ++i)
    lift[i] = system.coordinates[i].kind == fem::Coordinate::Kind::deflection ? 1.0 : 0.0;
  const auto model = reduction::project(system, {lift});
  EXPECT_NEAR(model.system.mass.coeff(0, 0), 3.055, 1e-12);
  EXPECT_EQ(fem::modes(model.system, 1).rigid, 1);
}

TEST(Projection, KeepsSmallEigenvaluesOnAFineMesh) {
  // Oracle: 3 EI / L^3 and 33/140 m. The quotient phi^T K phi of the assembled matrix is 3e-5 off.
  const fem::Cantilever beam = test::steel_beam(0.0);
  const auto model = reduce(assemble(beam, 2000), *reduction_registry().make("rayleigh", {}));
  EXPECT_NEAR(static_stiffness(model.system) / beam.tip_stiffness(), 1.0, 1e-11);
  EXPECT_NEAR(model.system.mass.coeff(0, 0) / (33.0 / 140.0 * beam.mass()), 1.0, 1e-11);
}

TEST(Projection, SaysThatAnAxialLoadBuckles) {
  fem::Beam beam = test::steel_beam(0.0);
  beam.axial_load = 2.0 * 2.4674011 * 228.96 / 1.21;
  EXPECT_THROW(reduce(assemble(beam, 10), *reduction_registry().make("guyan", {})), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::projection_test
