#include "fem/modes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "fem/assembly.hpp"
#include "fem/exact/exact_cantilever.hpp"
#include "fem/stiffness_solver.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::modes_test {
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

fem::Beam uniform_beam(std::vector<fem::Support> supports, double axial_load = 0.0) {
  fem::Beam beam;
  beam.segments = {{1.0, {1.0, 1.0, 0.0, {}, {}, {}}}};  // L = EI = rho A = 1: omega = b^2
  beam.supports = std::move(supports);
  beam.axial_load = axial_load;
  return beam;
}

constexpr double pi = std::numbers::pi;

TEST(AxialLoad, ChangesPinnedFrequenciesAsEulerFound) {
  // Oracle: omega_i = (i pi)^2 sqrt(1 - P / (i^2 P_1)), P_1 = pi^2 EI / L^2, in tension and below buckling.
  // Cubics err by (b h / L)^4 / 1440. Dense for 20 elements, Lanczos for 200.
  for (const int elements : {20, 200})
    for (const double load : {-5.0, -0.1, 0.1, 0.9, 0.9999}) {
      const auto system =
          assemble(uniform_beam({{0.0, true, false}, {1.0, true, false}}, load * pi * pi), elements);
      const auto modes = fem::modes(system, 4);
      for (int i = 1; i <= 4; ++i) {
        const double exact = i * i * pi * pi * std::sqrt(1.0 - load / (i * i));
        const double discretisation = std::pow(i * pi / elements, 4) / 500.0;
        EXPECT_NEAR(modes.angular_frequency[i - 1] / exact, 1.0,
                    discretisation / (1.0 - load / (i * i)) + 1e-11)
            << elements << " elements, load " << load << ", mode " << i;
      }
    }
}

TEST(AxialLoad, BeyondBucklingIsReported) {
  // At 3.9 times the buckling load mode 2, at 4 times it, is nearer to zero than the unstable mode 1: the
  // lowest eigenvalue in magnitude is a positive one.
  for (const int elements : {20, 200})
    for (const double load : {1.001, 3.9, 50.0}) {
      const auto system =
          assemble(uniform_beam({{0.0, true, false}, {1.0, true, false}}, load * pi * pi), elements);
      try {
        fem::modes(system, 1);
        ADD_FAILURE() << elements << " elements, load " << load;
      } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("unstable")) << load;
        EXPECT_THAT(error.what(), testing::HasSubstr("omega^2 = -")) << load;
      }
    }
}

TEST(RigidBodyModes, ComeFirstWithFrequencyZero) {
  // Oracle: a free beam moves in two ways, one pinned or guided in one place in one, and strains in neither.
  struct Case {
    std::vector<fem::Support> supports;
    Eigen::Index rigid;
  };
  const std::vector<Case> cases = {{{}, 2},
                                   {{{0.0, true, false}}, 1},
                                   {{{0.0, false, true}}, 1},
                                   {{{0.0, false, true}, {1.0, false, true}}, 1},
                                   {{{0.5, true, false}}, 1},
                                   {{{0.0, true, true}}, 0}};
  for (const auto& [supports, rigid] : cases)
    for (const int elements : {10, 200}) {
      const auto system = assemble(uniform_beam(supports), elements, {});
      const auto modes = fem::modes(system, 5);
      ASSERT_EQ(modes.rigid, rigid);
      for (Eigen::Index i = 0; i < rigid; ++i) {
        EXPECT_EQ(modes.angular_frequency[i], 0.0);
        EXPECT_EQ(modes.residual[i], 0.0);
        EXPECT_EQ(modes.digits(i), 15.0);
        EXPECT_LT((system.stiffness.strain * modes.shape.col(i)).cwiseAbs().maxCoeff(), 1e-14);
      }
      EXPECT_GT(modes.angular_frequency[rigid], 1.0);
      const Eigen::MatrixXd gram = modes.shape.transpose() * (system.mass * modes.shape);
      EXPECT_LT((gram - Eigen::MatrixXd::Identity(5, 5)).cwiseAbs().maxCoeff(), 1e-10);
    }
}

TEST(RigidBodyModes, OfAFreeBeamAreTranslationAndRotationAboutItsCentreOfMass) {
  const auto system = assemble(uniform_beam({}), 50, {});
  const auto modes = fem::modes(system, 2);
  const Eigen::VectorXd translation = nodal_deflection(system, modes.shape.col(0)),
                        rotation = nodal_deflection(system, modes.shape.col(1));
  EXPECT_NEAR((translation.cwiseAbs().array() - 1.0).abs().maxCoeff(), 0.0, 1e-13);  // mass 1
  EXPECT_NEAR(rotation[25], 0.0, 1e-13);
  EXPECT_NEAR(std::abs(rotation[50]), 0.5 * std::sqrt(12.0), 1e-12);  // rotary inertia 1/12
}

TEST(RigidBodyModes, AllModesOfAFreeBeamIncludeThem) {
  // Oracle: free-free and clamped-clamped beams share their frequencies, cubics raise both by (b h / L)^4 /
  // 1440.
  const auto free = fem::modes(assemble(uniform_beam({}), 20, {}), 42);
  const auto clamped = fem::modes(assemble(uniform_beam({{0.0, true, true}, {1.0, true, true}}), 20), 1);
  EXPECT_EQ(free.rigid, 2);
  EXPECT_NEAR(free.angular_frequency[2] / clamped.angular_frequency[0], 1.0, 1e-6);
  EXPECT_TRUE(std::is_sorted(free.angular_frequency.begin(), free.angular_frequency.end()));
}

TEST(RigidBodyModes, OfATautFreeBeamKeepOnlyTheTranslation) {
  // A dead tension pulls a rotated free beam back: what is left is translation. Solved as a mixed system.
  const auto modes = fem::modes(assemble(uniform_beam({}, -1.0), 50, {}), 3);
  EXPECT_EQ(modes.rigid, 1);
  EXPECT_GT(modes.angular_frequency[1], 1.0);
}

TEST(Modes, LeaveOutWhatHasNoMass) {
  // Half of the coordinates without mass: half as many modes, by either method, and no more.
  auto without_rotary_inertia = [](int elements) {
    auto beam = uniform_beam({{0.0, true, true}});
    beam.mass_model = fem::MassModel::lumped;
    auto system = assemble(beam, elements);
    for (Eigen::Index i = 1; i < system.size(); i += 2) system.mass.coeffRef(i, i) = 0.0;
    return system;
  };
  const auto small = without_rotary_inertia(20), large = without_rotary_inertia(100);
  const auto few = fem::modes(small, 20), many = fem::modes(large, 5);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(few.angular_frequency[i] / many.angular_frequency[i], 1.0, 0.02) << i;
  EXPECT_LT(few.residual.head(3).maxCoeff(), 1e-9);
  EXPECT_THROW(fem::modes(small, 21), std::runtime_error);
}

TEST(Modes, ReportHowManyDigitsTheFormsShare) {
  const auto modes = fem::modes(assemble(uniform_beam({{0.0, true, true}}), 100), 2);
  EXPECT_GT(modes.digits(0), 12.0);
  fem::Modes coarse = modes;
  coarse.rayleigh_angular_frequency[1] *= 1.0 + 1e-6;
  EXPECT_NEAR(coarse.digits(1), 6.0, 0.01);
}

}  // namespace
}  // namespace beamid::modes_test
