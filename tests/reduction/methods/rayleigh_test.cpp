// One coordinate and an assumed shape.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fem/assembly.hpp"
#include "fem/exact/exact_cantilever.hpp"
#include "fem/modes.hpp"
#include "fem/stiffness_solver.hpp"
#include "reduction/reduction.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::rayleigh_test {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using reduction::reduction_registry;

std::unique_ptr<reduction::Reduction> rayleigh(const std::string& shape) {
  return reduction_registry().make("rayleigh", {{"shape", shape}});
}

TEST(Rayleigh, EquivalentMassIs33Over140OnAnyMesh) {
  // Oracle: integral of ((3 L x^2 - x^3) / 2 L^3)^2 over the beam = 33/140 L, by hand.
  const fem::Cantilever beam = test::steel_beam(0.36049);
  for (const int elements : {1, 2, 13, 80}) {
    const auto model = reduce(assemble(beam, elements), *reduction_registry().make("rayleigh", {}));
    EXPECT_NEAR(model.system.mass.coeff(0, 0), 33.0 / 140.0 * beam.mass() + beam.tip_mass, 1e-10);
    EXPECT_NEAR(static_stiffness(model.system) / beam.tip_stiffness(), 1.0, 1e-10);
  }
}

TEST(Rayleigh, OneMinusCosineHasItsOwnMassAndStiffness) {
  // Oracle: integrals of (1 - cos)^2 and of the curvature squared, by hand: (3/2 - 4/pi) m and
  // pi^4 EI / 32 L^3.
  using std::numbers::pi;
  const fem::Cantilever beam = test::steel_beam(0.0);
  const auto model = reduce(assemble(beam, 80), *rayleigh("one_minus_cosine"));
  EXPECT_NEAR(model.system.mass.coeff(0, 0) / ((1.5 - 4.0 / pi) * beam.mass()), 1.0, 1e-8);
  EXPECT_NEAR(static_stiffness(model.system) / (std::pow(pi, 4) / 96.0 * beam.tip_stiffness()), 1.0, 1e-8);
}

TEST(Rayleigh, SelfWeightHasItsOwnMassAndStiffness) {
  // Oracle: w = (6 L^2 x^2 - 4 L x^3 + x^4) / 3 L^4, integrals of w^2 and w''^2 by hand: 104/405 m and
  // 16 EI / 5 L^3.
  const fem::Cantilever beam = test::steel_beam(0.0);
  const auto model = reduce(assemble(beam, 80), *rayleigh("self_weight"));
  EXPECT_NEAR(model.system.mass.coeff(0, 0) / (104.0 / 405.0 * beam.mass()), 1.0, 1e-7);
  EXPECT_NEAR(static_stiffness(model.system) / (16.0 / 15.0 * beam.tip_stiffness()), 1.0, 1e-7);
}

TEST(Rayleigh, TakesAGivenShape) {
  // Oracle: the static shape, given at three points, is the static shape.
  const fem::Cantilever beam = test::steel_beam(0.36049);
  const auto shape = [](double x) { return (3.0 * 1.1 * x * x - x * x * x); };
  const reduction::Training training{VectorXd{{0.25, 0.7, 1.1}},
                                     MatrixXd{{shape(0.25)}, {shape(0.7)}, {shape(1.1)}}};
  const auto model = reduce(assemble(beam, 20), *rayleigh("given"), training);
  EXPECT_NEAR(model.system.mass.coeff(0, 0), 33.0 / 140.0 * beam.mass() + beam.tip_mass, 1e-10);
  EXPECT_NEAR(static_stiffness(model.system) / beam.tip_stiffness(), 1.0, 1e-10);
  EXPECT_THROW(reduce(assemble(beam, 20), *rayleigh("given")), std::invalid_argument);
}

TEST(Rayleigh, LetsWhatHangsOnTheBeamFollow) {
  // Oracle: an absorber at rest relative to the beam adds its mass where it hangs, 1 - cos = 1 at the tip.
  fem::Beam beam = test::steel_beam(0.0);
  const double alone = reduce(assemble(beam, 20), *rayleigh("one_minus_cosine")).system.mass.coeff(0, 0);
  beam.absorbers = {{1.1, 0.2, 100.0, 0.0}};
  const auto model = reduce(assemble(beam, 20), *rayleigh("one_minus_cosine"));
  EXPECT_NEAR(model.system.mass.coeff(0, 0), alone + 0.2, 1e-10);
}

TEST(Rayleigh, RefusesShapesThatSupportsForbid) {
  // Oracle: at a propped tip 1 - cos is 1, and a free beam has no deflection under its own weight.
  fem::Beam propped = test::steel_beam(0.0);
  propped.supports.push_back({1.1, true, false});
  EXPECT_THROW(reduce(assemble(propped, 10), *rayleigh("one_minus_cosine")), std::invalid_argument);
  fem::Beam loose = test::steel_beam(0.0);
  loose.supports.clear();
  EXPECT_THROW(reduce(assemble(loose, 10), *rayleigh("self_weight")), std::invalid_argument);
  EXPECT_THROW(reduce(assemble(loose, 10), *rayleigh("static_tip_load")), std::invalid_argument);
}

TEST(Rayleigh, FrequencyErrorsOfTheFiveBeamsAreTheTabulatedOnes) {
  // Oracle: table of the study, computed outside this project: error of f1 in per cent.
  const double static_shape_error[] = {1.38833, 0.65267, 0.17907, 0.08120, 0.03957};
  const double cosine_error[] = {4.07, 2.70, 1.59, 1.27, 1.09};
  for (int i = 0; i < 5; ++i) {
    const fem::Cantilever beam = test::steel_beam(test::five_beams[i].tip_mass);
    const double exact = fem::ExactMode(beam, 1).angular_frequency();
    const auto error = [&](const char* shape) {
      const auto model = reduce(assemble(beam, 40), *rayleigh(shape));
      return 100.0 * (fem::modes(model.system, 1).angular_frequency[0] / exact - 1.0);
    };
    EXPECT_NEAR(error("static_tip_load"), static_shape_error[i], 5e-6);
    EXPECT_NEAR(error("one_minus_cosine"), cosine_error[i], 5e-3);
    EXPECT_GT(error("self_weight"), 0.0);
  }
}

TEST(Rayleigh, NamesTheShapesItKnows) {
  try {
    rayleigh("cubic");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "unknown shape 'cubic' of reduction 'rayleigh'; known: given, one_minus_cosine, "
                 "self_weight, static_tip_load");
  }
}

}  // namespace
}  // namespace beamid::rayleigh_test
