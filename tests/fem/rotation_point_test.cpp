// Points whose rotation is meant.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "fem/assembly.hpp"

namespace beamid::fem::rotation_point_test {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

Beam cantilever() {
  Beam beam;
  Segment segment;
  segment.length = 2.0;
  segment.section.bending_stiffness = Variation(300.0);
  segment.section.mass_per_length = Variation(5.0);
  beam.segments = {segment};
  beam.supports = {{0.0}};
  return beam;
}

TEST(RotationPoint, IsTurnedByAMomentAndReadInRadians) {
  // Oracle: M L / E I, M L^2 / 2 E I of a moment at the tip; M x / E I half way.
  const StructuralSystem system =
      assemble(cantilever(), 6, {{"tip", 2.0}, {"tip", 2.0, {}, true}, {"middle", 1.0, {}, true}});
  const MatrixXd stiffness = system.stiffness.assembled();
  const VectorXd moved = system.outputs * stiffness.ldlt().solve(MatrixXd(system.inputs).col(1));
  EXPECT_NEAR(moved[0], 2.0 * 2.0 / (2.0 * 300.0), 1e-10);
  EXPECT_NEAR(moved[1], 2.0 / 300.0, 1e-10);
  EXPECT_NEAR(moved[2], 1.0 / 300.0, 1e-10);
  EXPECT_EQ(system.input_names[1], "tip_moment");
  EXPECT_EQ(system.output_names[2], "middle_rotation");
}

TEST(RotationPoint, HasNoShareOfTheBasesMotion) {
  const StructuralSystem system = assemble(cantilever(), 3, {{"tip", 2.0}, {"tip", 2.0, {}, true}});
  ASSERT_EQ(system.base_shares.size(), 2);
  EXPECT_EQ(system.base_shares[0], 1.0);
  EXPECT_EQ(system.base_shares[1], 0.0);
}

TEST(RotationPoint, IsRefusedWhereASupportHoldsIt) {
  Beam beam = cantilever();
  beam.supports.push_back({2.0, false, true});
  try {
    assemble(beam, 3, {{"tip", 2.0, {}, true}});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("does not rotate"));
  }
}

}  // namespace
}  // namespace beamid::fem::rotation_point_test
