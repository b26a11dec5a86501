// Oracles: the closed form of the uniform shear building, dense matrices of a chain, published frequencies of
// a soil column.
#include "fem/shear_building.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "fem/parametric_system.hpp"

namespace beamid::fem::shear_building_test {
namespace {

using Eigen::Index, Eigen::MatrixXd;

Beam uniform(std::size_t floors, double mass, double stiffness) {
  return shear_building({std::vector<double>(floors, mass), std::vector<double>(floors, stiffness), {}, {}});
}

// omega_j = 2 sqrt(k / m) sin((2 j - 1) pi / (2 (2 n + 1)))
TEST(ShearBuilding, HasTheFrequenciesOfTheClosedForm) {
  for (const std::size_t n : {1u, 2u, 12u, 200u}) {
    const Modes found = modes(assemble(uniform(n, 800.0, 3e6), 1), static_cast<Index>(n));
    for (std::size_t j = 1; j <= n; ++j) {
      const double argument = static_cast<double>(2 * j - 1) / static_cast<double>(2 * n + 1);
      EXPECT_NEAR(found.angular_frequency[static_cast<Index>(j) - 1] /
                      (2.0 * std::sqrt(3e6 / 800.0) * std::sin(0.5 * std::numbers::pi * argument)),
                  1.0, 1e-13)
          << j << " of " << n;
    }
  }
}

TEST(ShearBuilding, HasTheMatricesOfAChain) {
  const StructuralSystem system =
      assemble(shear_building({{100, 200, 300}, {1e5, 2e5, 4e5}, {10, 20, 40}, {3, 4, 5}}), 40);
  MatrixXd mass = MatrixXd::Zero(3, 3), stiffness(3, 3), damping(3, 3);
  mass.diagonal() << 100, 200, 300;
  stiffness << 3e5, -2e5, 0, -2e5, 6e5, -4e5, 0, -4e5, 4e5;
  damping << 30, -20, 0, -20, 60, -40, 0, -40, 40;
  EXPECT_LT((MatrixXd(system.mass) - mass).norm(), 1e-12 * mass.norm());
  EXPECT_LT((MatrixXd(system.stiffness.assembled()) - stiffness).norm(), 1e-14 * stiffness.norm());
  EXPECT_LT((MatrixXd(system.damping) - damping).norm(), 1e-14 * damping.norm());
  EXPECT_LT((MatrixXd(system.inputs).rightCols(1) + mass.diagonal()).norm(), 1e-12 * mass.norm());
}

// J.-S. Lin's three layers as a column of a square metre: 2.505, 5.508 and 8.341 Hz.
TEST(ShearBuilding, OfSoilHasTheFrequenciesOfItsLayers) {
  const Storeys column = soil_column({{6, 1900, 190}, {5, 1900, 160}, {6, 1900, 120}});
  EXPECT_NEAR(column.stiffnesses[2], 4.560e6, 500.0);
  EXPECT_NEAR(column.stiffnesses[1], 9.728e6, 500.0);
  EXPECT_NEAR(column.stiffnesses[0], 11.432e6, 500.0);
  const Eigen::VectorXd found = modes(assemble(shear_building(column), 3), 3).frequency_hz();
  EXPECT_NEAR(found[0], 2.505, 5e-4);
  EXPECT_NEAR(found[1], 5.508, 5e-4);
  EXPECT_NEAR(found[2], 8.341, 5e-4);
}

// Oracle: differences of two assemblies, exact as the equations are affine.
TEST(ShearBuilding, IsAffineInItsStoreys) {
  const Beam beam = shear_building({{1, 2, 3, 4}, {10, 20, 30, 40}, {0.1, 0.2, 0.3, 0.4}, {}});
  using Quantity = BeamParameter::Quantity;
  const std::vector<BeamParameter> asked{{Quantity::storey_stiffness, std::pair{1.0, 3.0}},
                                         {Quantity::storey_damping, std::pair{2.0, 4.0}},
                                         {Quantity::body_mass, std::pair{2.5, 3.5}}};
  const std::vector<Point> points{{"tip", 4.0}};
  const ParametricSystem system = assemble_parametric(beam, 4, points, asked);
  EXPECT_DOUBLE_EQ(system.values[0], 25.0);
  EXPECT_NEAR(system.values[1], 0.35, 1e-15);
  EXPECT_DOUBLE_EQ(system.values[2], 3.0);
  Beam other = beam;
  const Eigen::Vector3d values(30.0, 0.5, 2.0);
  for (std::size_t j = 0; j < asked.size(); ++j)
    other = with_value(other, asked[j], values[static_cast<Index>(j)]);
  const StructuralSystem moved = assemble(other, 4, points);
  MatrixXd mass = system.system.mass, damping = system.system.damping,
           stiffness = system.system.stiffness.assembled(), inputs = system.system.inputs;
  for (std::size_t j = 0; j < asked.size(); ++j) {
    const double change = values[static_cast<Index>(j)] - system.values[static_cast<Index>(j)];
    const auto& slope = system.derivatives[j];
    mass += change * MatrixXd(slope.mass);
    stiffness += change * MatrixXd(system.stiffness_derivative(j));
    inputs += change * MatrixXd(slope.inputs);
    if (slope.damping.nonZeros() > 0) damping += change * MatrixXd(slope.damping);
  }
  EXPECT_LT((mass - MatrixXd(moved.mass)).norm(), 1e-13 * mass.norm());
  EXPECT_LT((stiffness - MatrixXd(moved.stiffness.assembled())).norm(), 1e-13 * stiffness.norm());
  EXPECT_LT((damping - MatrixXd(moved.damping)).norm(), 1e-13 * damping.norm());
  EXPECT_LT((inputs - MatrixXd(moved.inputs)).norm(), 1e-13 * inputs.norm());
}

TEST(ShearBuilding, RefusesWhatItCannotBe) {
  const auto message = [](const auto& act) -> std::string {
    try {
      act();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "nothing was refused";
  };
  using testing::HasSubstr;
  EXPECT_THAT(message([] {
                shear_building({{1, 2}, {1}, {}, {}});
              }),
              HasSubstr("1 stiffnesses for 2 floors; expected one for each"));
  EXPECT_THAT(message([] {
                shear_building({{1, 0}, {1, 1}, {}, {}});
              }),
              HasSubstr("masses: number 2 is 0; expected positive numbers"));
  EXPECT_THAT(message([] { shear_building({{}, {}, {}, {}}); }), HasSubstr("without floors"));
  const Beam beam = uniform(3, 1.0, 1.0);
  EXPECT_THAT(message([&] {
                assemble(beam, 3, {{"between", 1.5}});
              }),
              HasSubstr("a point lies between two floors; expected the height of one: 1 2 3 m"));
  const BeamParameter part{BeamParameter::Quantity::storey_stiffness, std::pair{0.0, 1.5}};
  EXPECT_THAT(message([&] { value_of(beam, part); }), HasSubstr("expected ends at the heights of floors"));
}

}  // namespace
}  // namespace beamid::fem::shear_building_test
