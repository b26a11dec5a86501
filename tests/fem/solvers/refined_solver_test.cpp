// Oracle: the mixed solver, which assembles nothing; equilibrium itself.
#include "fem/solvers/refined_solver.hpp"

#include <gtest/gtest.h>

#include "fem/modes.hpp"
#include "fem/space_frame.hpp"
#include "fem/stiffness_solver.hpp"

namespace beamid::fem::refined_solver_test {
namespace {

using Eigen::VectorXd;

// 3 x 2 bays and 3 storeys: more loops than the sweeps of a chain serve.
SpaceFrame building(double axial) {
  SpaceSection section;
  section.axial_stiffness = axial, section.bending_stiffness_y = 1.1e7, section.bending_stiffness_z = 7e6;
  section.torsional_stiffness = 4e6, section.mass_per_length = 60.0, section.torsional_inertia = 0.4;
  SpaceFrame frame;
  const auto at = [](int i, int j, int k) { return (k * 3 + j) * 4 + i; };
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 4; ++i) {
        frame.joints.push_back({{6.0 * i, 5.0 * j, 3.5 * k}, ""});
        if (k == 0) frame.supports.push_back({at(i, j, 0)});
        if (k > 0) frame.members.push_back({at(i, j, k - 1), at(i, j, k), section});
        if (k > 0 && i < 3) frame.members.push_back({at(i, j, k), at(i + 1, j, k), section});
        if (k > 0 && j < 2) frame.members.push_back({at(i, j, k), at(i, j + 1, k), section});
      }
  return frame;
}

struct Solved {
  VectorXd motion, forces;
};

template <class Solver>
Solved solved(const Solver& solver, const StructuralSystem& system, const VectorXd& load) {
  Solved found{VectorXd(system.size()), VectorXd(system.stiffness.strain.rows())};
  solver.solve(load, found.motion, found.forces);
  return found;
}

TEST(RefinedSolver, FindsWhatTheMixedSolverFinds) {
  const StructuralSystem system = assemble(building(1.6e9), 4);
  const RefinedSolver refined(system.stiffness, {});
  ASSERT_TRUE(refined.serves());
  const VectorXd load = VectorXd::LinSpaced(system.size(), -1.0, 2.0);
  const Solved found = solved(refined, system, load),
               expected = solved(MixedSolver(system.stiffness), system, load);
  EXPECT_LE((found.motion - expected.motion).norm(), 1e-12 * expected.motion.norm());
  EXPECT_LE((found.forces - expected.forces).norm(), 1e-12 * expected.forces.norm());
  EXPECT_LE((system.stiffness.strain.transpose() * found.forces - load).norm(), 1e-12 * load.norm());
}

// The assembled K has lost its digits to members that hardly stretch; corrections bring them back.
TEST(RefinedSolver, BringsBackTheDigitsThatAssemblyLoses) {
  const StructuralSystem system = assemble(building(1.6e13), 8);
  const RefinedSolver refined(system.stiffness, {});
  ASSERT_TRUE(refined.serves());
  const VectorXd load = VectorXd::LinSpaced(system.size(), -1.0, 2.0);
  const Solved found = solved(refined, system, load),
               expected = solved(MixedSolver(system.stiffness), system, load);
  EXPECT_LE((found.motion - expected.motion).norm(), 1e-11 * expected.motion.norm());
}

TEST(RefinedSolver, SaysWhereItDoesNotServe) {
  SpaceFrame free = building(1.6e9);
  free.supports.clear();
  EXPECT_FALSE(RefinedSolver(assemble(free, 2).stiffness, {}).serves());
}

// Oracle: the same building with a mesh so coarse that the mixed solver serves it.
TEST(RefinedSolver, KeepsTheMotionsWithoutStrainOfAFreeBuildingApart) {
  SpaceFrame free = building(1.6e9);
  free.supports.clear();
  const StructuralSystem coarse = assemble(free, 2), fine = assemble(free, 6);
  ASSERT_LT(coarse.size(), 2000);
  ASSERT_GT(fine.size(), 2000);
  const Modes of_coarse = modes(coarse, 9), of_fine = modes(fine, 9);
  EXPECT_EQ(of_fine.rigid, 6);
  for (int i = 6; i < 9; ++i) {
    EXPECT_NEAR(of_fine.angular_frequency[i] / of_coarse.angular_frequency[i], 1.0, 2e-3) << i;
    EXPECT_GE(of_fine.digits(i), 10) << i;
  }
}

}  // namespace
}  // namespace beamid::fem::refined_solver_test
