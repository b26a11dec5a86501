// The mass that a motion of the base moves. Oracles: the floors of a shear building; of a uniform cantilever
// the first mode's share of all mass, 4 sigma^2 / (beta L)^2 with beta L = 1.8751, sigma = 0.7341: 0.6131.
#include "fem/structural_system.hpp"

#include <gtest/gtest.h>

#include "beamid/testing/steel_beam.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "fem/shear_building.hpp"

namespace beamid::fem::moved_mass_test {
namespace {

TEST(MovedMass, OfAShearBuildingIsThatOfItsFloorsAndAllModesShareIt) {
  const StructuralSystem system =
      assemble(shear_building({{700.0, 500.0, 300.0}, {1e6, 2e6, 1e6}, {}, {}}), 1);
  const Eigen::Index base = system.inputs.cols() - 1;
  EXPECT_NEAR(moved_mass(system, base), 1500.0, 1e-9);
  const Eigen::MatrixXd shapes = modes(system, 3).shape;
  EXPECT_NEAR(moved_share(system, base, shapes), 1.0, 1e-12);
  EXPECT_LT(moved_share(system, base, shapes.leftCols(1)), 0.98);
}

TEST(MovedMass, OfACantileverIsSharedByItsFirstModeAsInClosedForm) {
  const StructuralSystem system = assemble(test::steel_beam(0.0), 200);
  const Eigen::Index base = system.inputs.cols() - 1;
  EXPECT_NEAR(moved_share(system, base, modes(system, 1).shape), 0.6131, 2e-3);
}

}  // namespace
}  // namespace beamid::fem::moved_mass_test
