// Oracle: the exact cantilever; its curvature at the root, extrapolated from its shape near it, is good to
// 1e-8.
#include "fem/parametric_system.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/exact/exact_cantilever.hpp"
#include "fem/modes.hpp"
#include "fem/stiffness_solver.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::fem::gauge_row_test {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

// w'' at the root: w(x) = a x^2 / 2 + b x^3 / 6 + O(x^6) there.
double root_curvature(const ExactMode& mode, double length) {
  const double x = 1e-3 * length, y = 2e-3 * length;
  const double f = 2.0 * mode.shape(x) / (x * x), g = 2.0 * mode.shape(y) / (y * y);
  return 2.0 * f - g;
}

TEST(GaugeRow, ReadsHighModesAtAClampedRoot) {
  const Cantilever beam = test::steel_beam(0.36);
  const auto system = assemble(beam, 40);
  const Modes found = modes(system, 12);
  for (const auto& [mode, most] : {std::pair{1, 1e-7}, {3, 3e-5}, {5, 3e-4}, {12, 6e-3}}) {
    const VectorXd shape = found.shape.col(mode - 1);
    const double read = (gauge_row(system, beam, 0.0) * shape)[0] / (system.outputs * shape)[0];
    EXPECT_LT(std::abs(read / root_curvature(ExactMode(beam, mode), beam.length) - 1.0), most) << mode;
  }
}

// Oracle: w'' = F (L - x) / EI, also with shear deformation, and on both sides of a clamp within the beam.
// What is no clamp is read as ever.
TEST(GaugeRow, IsExactUnderAStaticTipForce) {
  Beam beam = test::steel_beam(0.0);
  const double stiffness = beam.segments[0].section.bending_stiffness(0.0);
  beam.segments[0].section.shear_stiffness = 2e4;
  const auto curvature = [&](double x) {
    const auto system = assemble(beam, 11);
    const VectorXd q = StiffnessSolver(system.stiffness).solve(MatrixXd(system.inputs.col(0)));
    return (gauge_row(system, beam, x) * q)[0];
  };
  EXPECT_NEAR(curvature(0.0), 1.1 / stiffness, 1e-11 / stiffness);
  EXPECT_NEAR(curvature(0.6), 0.5 / stiffness, 1e-11 / stiffness);
  beam.supports.push_back({0.3, true, true});
  EXPECT_NEAR(curvature(0.3), 0.5 * 0.8 / stiffness, 1e-11 / stiffness);  // the mean of both sides
}

// Oracle: the polynomial through the rotations around, curvature_row().
TEST(GaugeRow, AgreesWithThePolynomialWhereItMustNotBeUsed) {
  for (const int kind : {0, 1, 2}) {
    Beam beam = test::steel_beam(0.36);
    if (kind == 0) beam.axial_load = -2000.0;
    if (kind == 1) beam.mass_model = MassModel::lumped;
    if (kind == 2) beam.segments[0].section.bending_stiffness = Variation::linear(200.0, 120.0);
    const auto system = assemble(beam, 40);
    EXPECT_EQ((MatrixXd(gauge_row(system, beam, 0.0)) - MatrixXd(curvature_row(system, 0.0))).norm(), 0.0)
        << kind;
  }
}

}  // namespace
}  // namespace beamid::fem::gauge_row_test
