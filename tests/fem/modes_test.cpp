#include "fem/modes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/assembly.hpp"
#include "fem/exact_cantilever.hpp"
#include "fem/stiffness_solver.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid {
namespace {

using fem::ExactMode;

TEST(Cantilever, StaticTipStiffnessIsThreeEIOverLCubed) {
  // Oracle: beam theory; Hermite cubics contain the static solution, so only rounding remains.
  for (const int elements : {1, 7, 80, 400}) {
    const fem::Cantilever beam = test::steel_beam(1.0);
    EXPECT_NEAR(fem::static_stiffness(assemble(beam, elements)) / beam.tip_stiffness(), 1.0, 1e-11)
        << elements;
  }
}

TEST(Cantilever, FirstFrequencyOfTheFiveBeamsIsExactToNineDigits) {
  for (const auto& known : test::five_beams) {
    const auto modes = fem::modes(assemble(test::steel_beam(known.tip_mass), 80), 5);
    EXPECT_NEAR(modes.frequency_hz()[0] / known.frequency_hz, 1.0, 1e-9);
  }
}

TEST(Cantilever, ModesTwoToFiveAreExactToSixDigits) {
  for (const auto& known : test::five_beams) {
    const fem::Cantilever beam = test::steel_beam(known.tip_mass);
    const auto modes = fem::modes(assemble(beam, 80), 5);
    for (int i = 2; i <= 5; ++i)
      EXPECT_NEAR(modes.frequency_hz()[i - 1] / ExactMode(beam, i).frequency_hz(), 1.0, 1e-6) << "mode " << i;
  }
}

TEST(Cantilever, FrequenciesConvergeAtOrderFourFromAbove) {
  // Oracle: Hermite cubics with consistent mass err by (b h / L)^4 / 1440 in frequency, b the exact root of
  // the bare beam; a tip mass, which is not discretised, lowers the factor and keeps the order.
  for (const double tip_mass : {0.0, 0.36049}) {
    const fem::Cantilever beam = test::steel_beam(tip_mass);
    const ExactMode exact(beam, 3);
    const auto error = [&](int elements) {
      return fem::modes(assemble(beam, elements), 3).angular_frequency[2] / exact.angular_frequency() - 1.0;
    };
    const double coarse = error(20), fine = error(40);
    EXPECT_GT(fine, 0.0);
    EXPECT_NEAR(std::log2(coarse / fine), 4.0, 0.02);
    if (tip_mass == 0.0) {
      EXPECT_NEAR(fine / (std::pow(exact.root() / 40, 4) / 1440.0), 1.0, 0.01);
    }
  }
}

TEST(Cantilever, TipRotaryInertiaMatchesTheExactRoots) {
  fem::Cantilever beam = test::steel_beam(1.33809);
  beam.tip_rotary_inertia = 0.05 * beam.mass() * beam.length * beam.length;
  const auto modes = fem::modes(assemble(beam, 80), 4);
  for (int i = 1; i <= 4; ++i) {
    const ExactMode exact(beam, i);
    EXPECT_NEAR(modes.angular_frequency[i - 1] / exact.angular_frequency(), 1.0, i == 1 ? 1e-9 : 1e-6);
    const Eigen::VectorXd tip = assemble(beam, 80).outputs * modes.shape.col(i - 1);
    EXPECT_NEAR(1.0 / (tip[0] * tip[0]) / exact.mass_at_tip(), 1.0, 1e-5) << "modal mass " << i;
  }
}

TEST(Modes, LanczosAndSingularValuesAgree) {
  // Two methods on one system: few modes go through shift-invert Lanczos, most through the dense factor.
  const auto system = assemble(test::steel_beam(0.36049), 40);
  const auto few = fem::modes(system, 6), all = fem::modes(system, 80);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(few.angular_frequency[i] / all.angular_frequency[i], 1.0, 1e-10);
    EXPECT_NEAR(std::abs(few.shape.col(i).dot(system.mass * all.shape.col(i))), 1.0, 1e-9);
    EXPECT_LT(few.residual[i], 1e-8);
  }
}

TEST(Modes, ShapesAreOrthonormalInMassAndStiffness) {
  const auto system = assemble(test::steel_beam(2.330965), 30);
  const auto all = fem::modes(system, 60);
  const Eigen::MatrixXd gram = all.shape.transpose() * (system.mass * all.shape);
  EXPECT_LT((gram - Eigen::MatrixXd::Identity(60, 60)).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(Modes, NoWrongFrequencyIsReturnedForMassesFarApart) {
  // Oracle: a beam so much lighter than its tip mass is a spring. What Lanczos cannot find it must refuse.
  for (const double tip_mass : {1e3, 1e5, 1e7, 1e9}) {
    const fem::Cantilever beam = test::steel_beam(tip_mass);
    const auto system = assemble(beam, 80);
    try {
      EXPECT_NEAR(fem::modes(system, 1).angular_frequency[0] / std::sqrt(beam.tip_stiffness() / tip_mass),
                  1.0, 1e-3)
          << tip_mass;
    } catch (const std::runtime_error&) {
      EXPECT_GT(tip_mass, 1e6);
    }
  }
}

TEST(Modes, RefusesMoreModesThanCoordinates) {
  const auto system = assemble(test::steel_beam(0.0), 3);
  EXPECT_THROW(fem::modes(system, 7), std::invalid_argument);
  EXPECT_THROW(fem::modes(system, 0), std::invalid_argument);
}

TEST(StiffnessSolver, ReportsAMechanism) {
  auto system = assemble(test::steel_beam(0.0), 2);
  system.stiffness.strain.coeffRef(0, 0) = system.stiffness.strain.coeffRef(0, 1) =
      0.0;  // a hinge at the root ...
  system.stiffness.strain.coeffRef(1, 0) = system.stiffness.strain.coeffRef(1, 1) =
      0.0;  // ... and no first element
  EXPECT_THROW(fem::StiffnessSolver{system.stiffness}, std::runtime_error);
}

}  // namespace
}  // namespace beamid
