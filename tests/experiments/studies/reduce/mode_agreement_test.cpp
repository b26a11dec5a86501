// Oracles: modes of one model are orthogonal in its mass; vectors small enough for a hand.
#include "experiments/studies/reduce/report.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::experiments::mode_agreement_test {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

TEST(MassWeightedMac, OfAModelsOwnModesIsTheIdentity) {
  const auto system = assemble(test::steel_beam(0.36049), 20);
  const MatrixXd shapes = fem::modes(system, 6).shape;
  const MatrixXd scaled = shapes * VectorXd::LinSpaced(6, -1.0, 8.0).asDiagonal();
  EXPECT_LT((mac(shapes, scaled, system.mass) - MatrixXd::Identity(6, 6)).norm(), 1e-12);
}

// With a mass at the tip deflections alone are not orthogonal: that is why the weight is there.
TEST(PlainMac, OfDifferentModesIsNotZero) {
  const auto system = assemble(test::steel_beam(3.644615), 20);
  const MatrixXd shapes = fem::modes(system, 2).shape;
  MatrixXd deflection(21, 2);
  for (int i = 0; i < 2; ++i) deflection.col(i) = fem::nodal_deflection(system, shapes.col(i));
  EXPECT_GT(mac(deflection, deflection)(0, 1), 0.1);
  EXPECT_NEAR(mac(deflection, deflection)(0, 0), 1.0, 1e-14);
}

TEST(PlainMac, IsTheSquaredCosine) {
  const Eigen::Vector2d along(1.0, 0.0), aslant(1.0, -std::sqrt(3.0));
  EXPECT_NEAR(mac(along, aslant)(0, 0), 0.25, 1e-15);
}

TEST(Partners, AreTheModesAboveAHalf) {
  MatrixXd values(3, 3);
  values << 0.1, 0.9, 0.0, 0.6, 0.0, 0.4, 0.3, 0.1, 0.5;
  EXPECT_EQ(partners(values), (std::vector<Eigen::Index>{1, 0, -1}));
  EXPECT_EQ(partners(MatrixXd(2, 0)), (std::vector<Eigen::Index>{-1, -1}));
}

TEST(Comac, OfIdenticalSetsIsOneWhereSomethingMoves) {
  const auto system = assemble(test::steel_beam(0.36049), 10);
  const MatrixXd shapes = fem::modes(system, 4).shape;
  MatrixXd deflection(11, 4);
  for (int i = 0; i < 4; ++i) deflection.col(i) = fem::nodal_deflection(system, shapes.col(i));
  const VectorXd found = comac(deflection, -deflection);
  EXPECT_TRUE(std::isnan(found[0]));  // the clamped root
  for (int p = 1; p < 11; ++p) EXPECT_NEAR(found[p], 1.0, 1e-14);
}

TEST(Comac, ShowsThePointThatDiffers) {
  const MatrixXd phi{{1.0, 2.0}, {1.0, 1.0}}, psi{{1.0, 2.0}, {1.0, 0.0}};
  EXPECT_NEAR(comac(phi, psi)[0], 1.0, 1e-15);
  EXPECT_NEAR(comac(phi, psi)[1], 0.5, 1e-15);  // (1 + 0)^2 / (2 x 1)
}

}  // namespace
}  // namespace beamid::experiments::mode_agreement_test
