#include "fem/section.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/assembly.hpp"
#include "fem/modes.hpp"

namespace beamid::variation_test {
namespace {

using fem::Variation;

TEST(Variation, VanishesExactlyAtASharpEndAndKeepsItsDigitsBesideIt) {
  // Oracle: (1 - s)^4 computed from 1 - s itself; a power series in s has lost all digits there.
  const Variation height = Variation::linear(0.01, 0.0), squared = height * height;
  const Variation cone = squared * squared;
  EXPECT_EQ(cone(1.0), 0.0);
  for (const double rest : {1e-3, 0x1p-20, 0x1p-30})
    EXPECT_NEAR(cone(1.0 - rest) / std::pow(0.01 * (1.0 - (1.0 - rest)), 4), 1.0, 1e-14) << rest;
}

TEST(Variation, HasTheMeanOfItsPolynomial) {
  // Oracle: (1 + s)(2 - s)^3 = 8 - 4 s - 6 s^2 + 5 s^3 - s^4, integrated term by term.
  const Variation falling = Variation::linear(2.0, 1.0);
  const Variation product = Variation::linear(1.0, 2.0) * falling * falling * falling;
  EXPECT_NEAR(product.mean(), 8.0 - 2.0 - 2.0 + 1.25 - 0.2, 1e-14);
  EXPECT_FALSE(product.is_constant());
  EXPECT_TRUE(Variation::linear(3.0, 3.0).is_constant());
  EXPECT_THROW(product * falling, std::invalid_argument);
}

fem::Beam sharp_pyramid() {
  const Variation side = Variation::linear(0.01, 0.0), area = side * side;
  fem::Beam beam;
  beam.segments = {{0.5, {Variation(833.0e8) * area * area, Variation(7850.0) * area, 0.0, {}, {}, {}}}};
  beam.supports = {{0.0, true, true}};
  return beam;
}

TEST(SharpTip, IsTheSameOnFineMeshes) {
  // Oracle: the converged frequency, the error of which falls with the mesh; 40,000 elements once overflowed
  // the stack.
  const double coarse = fem::modes(assemble(sharp_pyramid(), 2000), 1).angular_frequency[0];
  const double fine = fem::modes(assemble(sharp_pyramid(), 40000), 1).angular_frequency[0];
  EXPECT_NEAR(fine / coarse, 1.0, 1e-8);
}

TEST(SharpTip, CarriesNothing) {
  fem::Beam beam = sharp_pyramid();
  beam.bodies = {{0.5, 0.1, 0.0, 0.0}};
  EXPECT_THROW(fem::validate(beam), std::invalid_argument);
  EXPECT_EQ(fem::natural_point(sharp_pyramid()).name, "midspan");
}

}  // namespace
}  // namespace beamid::variation_test
