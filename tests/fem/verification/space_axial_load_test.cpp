// Members of a space frame under an axial load P, positive in compression, in both planes of bending and in
// torsion. Oracles: closed forms of the beam-column and of the loaded shaft [timoshenko1961].
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "fem/modes.hpp"
#include "fem/space_frame.hpp"
#include "fem/stiffness_solver.hpp"
#include "tests/fem/space_bars.hpp"

namespace beamid::space_axial_load_test {
namespace {

using Eigen::Vector3d;
using fem::test::bar;
using std::numbers::pi;

constexpr double length = 2.0;

// A column that leans, its section turned about it.
fem::SpaceFrame column(double load, const fem::SpaceSection& section = bar()) {
  fem::SpaceFrame frame;
  frame.joints = {{{0, 0, 0}, ""}, {length * Vector3d(2, -1, 2).normalized(), ""}};
  frame.members = {{0, 1, section}};
  frame.members[0].roll = 0.6;
  frame.members[0].axial_load = load;
  frame.supports = {{0}};
  return frame;
}

// Force per displacement across the tip of a cantilever along its y and its z: the beam-column P / (tan(k L)
// / k - L), k^2 = P / EI, and its hyperbolic sister in tension.
TEST(SpaceAxialLoad, CantileverStandsAsTheBeamColumnInBothPlanes) {
  for (const double share : {0.7, -2.0}) {
    const double load = share * pi * pi * bar().bending_stiffness_z / (4 * length * length);
    const fem::SpaceFrame frame = column(load);
    const fem::StructuralSystem system = fem::assemble(frame, 40, {{"tip", 1}});
    const fem::StiffnessSolver solver(system.stiffness);
    const Eigen::Matrix3d axes = frame.axes(0);
    for (const auto& [axis, bending] :
         {std::pair{1, bar().bending_stiffness_z}, {2, bar().bending_stiffness_y}}) {
      const Eigen::MatrixXd force = system.inputs.leftCols(3) * axes.col(axis);
      const Vector3d moved = system.outputs * solver.solve(force);
      const double k = std::sqrt(std::abs(load) / bending);
      const double expected = load > 0.0 ? (std::tan(k * length) / k - length) / load
                                         : (length - std::tanh(k * length) / k) / -load;
      EXPECT_NEAR(axes.col(axis).dot(moved) / expected, 1.0, 1e-6) << share << axis;
      EXPECT_NEAR(axes.col(3 - axis).dot(moved) / expected, 0.0, 1e-9) << share << axis;
    }
  }
}

// omega^2 = omega_0^2 (1 - P / P_E) of the pinned column in each plane.
TEST(SpaceAxialLoad, PinnedColumnSoftensInBothPlanes) {
  const double euler = pi * pi * bar().bending_stiffness_z / (length * length);
  for (const double share : {-0.5, 0.4, 0.9}) {
    fem::SpaceFrame frame = column(share * euler);
    frame.supports.push_back({1});
    for (fem::SpaceFrame::End* const end : {&frame.members[0].at_first, &frame.members[0].at_second})
      end->y = end->z = true;
    const fem::Modes found = fem::modes(fem::assemble(frame, 40), 4);
    for (const double bending : {bar().bending_stiffness_z, bar().bending_stiffness_y}) {
      const double unloaded = std::pow(pi / length, 2) * std::sqrt(bending / bar().mass_per_length),
                   own_share = share * bar().bending_stiffness_z / bending;
      const double expected = unloaded * std::sqrt(1.0 - own_share);
      const double of_square = std::pow(pi / 40, 4) / 720 / (1.0 - own_share);  // (beta h)^4/720 of omega_0^2
      EXPECT_LE((found.angular_frequency.array() / expected - 1.0).abs().minCoeff(), 0.6 * of_square)
          << share;
    }
  }
}

// Euler's loads: a cantilever about its weak axis; one that bends stiffly loses its torsion first, at P (I_y
// + I_z) / A = GJ, where its tip is free to turn [timoshenko1961, 5.3].
TEST(SpaceAxialLoad, BucklesByBendingOrByTwisting) {
  const double euler = pi * pi * bar().bending_stiffness_z / (4 * length * length);
  EXPECT_NEAR(*fem::buckling_factor(column(0.4 * euler), 16), 2.5, 1e-5);
  EXPECT_FALSE(fem::buckling_factor(column(-euler)));
  fem::SpaceSection open = bar();
  open.torsional_stiffness = 100.0;
  const double twisting = open.torsional_stiffness * open.mass_per_length / open.torsional_inertia;
  ASSERT_LT(twisting, 0.5 * euler);
  EXPECT_NEAR(*fem::buckling_factor(column(0.5 * twisting, open), 1), 2.0, 1e-10);
  EXPECT_NEAR(*fem::buckling_factor(column(0.5 * twisting, open), 8), 2.0, 1e-10);
  EXPECT_NO_THROW(fem::validate(column(0.999 * twisting, open)));
  EXPECT_THROW(fem::validate(column(1.001 * twisting, open)), std::invalid_argument);
}

// omega = (pi / 2L) sqrt((GJ - P (I_y + I_z) / A) / rho (I_y + I_z)) of a shaft clamped at one end.
TEST(SpaceAxialLoad, LoadTakesFromTorsion) {
  fem::SpaceSection open = bar();
  open.torsional_stiffness = 300.0;
  for (const double share : {-1.0, 0.5}) {
    const double polar = open.torsional_inertia / open.mass_per_length,
                 load = share * open.torsional_stiffness / polar;
    const fem::Modes found = fem::modes(fem::assemble(column(load, open), 40), 3);
    const double expected =
        pi / (2 * length) * std::sqrt((1.0 - share) * open.torsional_stiffness / open.torsional_inertia);
    EXPECT_LE((found.angular_frequency.array() / expected - 1.0).abs().minCoeff(), 1e-8) << share;
  }
}

}  // namespace
}  // namespace beamid::space_axial_load_test
