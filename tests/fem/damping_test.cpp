#include "fem/structural_system.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::damping_test {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using fem::DampingLaw;

constexpr double turn = 2.0 * M_PI;

std::string message(const DampingLaw& law, const VectorXd& omega) {
  try {
    damping_ratios(law, omega);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ModalDamping, RepeatsItsLastRatio) {
  const VectorXd omega{{1.0, 2.0, 3.0, 4.0}};
  EXPECT_EQ(damping_ratios(fem::ModalDamping{{0.01, 0.02}}, omega), VectorXd({{0.01, 0.02, 0.02, 0.02}}));
  EXPECT_EQ(damping_ratios(fem::ModalDamping{{0.01}}, omega), VectorXd::Constant(4, 0.01));
}

TEST(ModalDamping, BeginsWithTheFirstModeThatVibrates) {
  const VectorXd omega{{0.0, 0.0, 3.0, 4.0}};
  const VectorXd ratios = damping_ratios(fem::ModalDamping{{0.01, 0.02}}, omega);
  EXPECT_TRUE(std::isnan(ratios[0]) && std::isnan(ratios[1]));
  EXPECT_EQ(ratios.tail(2), VectorXd({{0.01, 0.02}}));
  EXPECT_EQ(damping_rates(fem::ModalDamping{{0.01, 0.02}}, omega)[0], 0.0);
}

TEST(RayleighDamping, IsTheTextbookCurveThroughItsAnchors) {
  // Oracle: alpha = 2 w1 w2 (x1 w2 - x2 w1) / (w2^2 - w1^2), beta = 2 (x2 w2 - x1 w1) / (w2^2 - w1^2).
  const double w1 = turn * 3.0, w2 = turn * 40.0, x1 = 0.01, x2 = 0.03, gap = w2 * w2 - w1 * w1;
  const double alpha = 2 * w1 * w2 * (x1 * w2 - x2 * w1) / gap, beta = 2 * (x2 * w2 - x1 * w1) / gap;
  const VectorXd omega{{5.0, w1, 100.0, w2, 3000.0}};
  const fem::RayleighDamping law{{3.0, x1}, {40.0, x2}};
  const VectorXd ratios = damping_ratios(law, omega);
  for (int i = 0; i < omega.size(); ++i)
    EXPECT_NEAR(ratios[i], 0.5 * (alpha / omega[i] + beta * omega[i]), 1e-15 + 1e-14 * ratios[i]);
  EXPECT_NEAR(ratios[1], x1, 1e-16);
  EXPECT_NEAR(ratios[3], x2, 1e-16);
  EXPECT_NEAR(proportional_coefficients(law).mass, alpha, 1e-14 * alpha);
  EXPECT_NEAR(proportional_coefficients(law).stiffness, beta, 1e-14 * beta);
}

TEST(RayleighDamping, MatrixGivesEveryModeTheRatioOfTheLaw) {
  // Oracle: phi^T C phi = 2 xi omega for mass-normalised phi; the assembled K in C costs the digits.
  const auto system = assemble(test::steel_beam(0.36049), 20);
  const auto modes = fem::modes(system, 6);
  const fem::RayleighDamping law{{3.0, 0.01}, {100.0, 0.004}};
  const MatrixXd modal = modes.shape.transpose() * (proportional_damping(law, system) * modes.shape);
  const VectorXd rates = damping_rates(law, modes.angular_frequency);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(modal(i, i) / rates[i], 1.0, 1e-9) << "mode " << i + 1;
}

TEST(CaugheyDamping, PassesThroughAllItsAnchors) {
  const fem::CaugheyDamping law{{{2.0, 0.01}, {9.0, 0.02}, {30.0, 0.015}, {80.0, 0.03}}};
  VectorXd omega(4);
  for (int i = 0; i < 4; ++i) omega[i] = turn * law.anchors[i].frequency_hz;
  const VectorXd ratios = damping_ratios(law, omega);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(ratios[i], law.anchors[i].ratio, 1e-14);
}

TEST(CaugheyDamping, IsTheSeriesInPowersOfOmegaSquared) {
  // Oracle: the matrix M sum_j a_j (M^-1 K)^j itself, a_j from the three equations of the anchors.
  const auto system = assemble(test::steel_beam(1.33809), 3);
  const auto modes = fem::modes(system, 6);
  const VectorXd w = modes.angular_frequency;
  const fem::CaugheyDamping law{{{w[0] / turn, 0.01}, {w[1] / turn, 0.008}, {w[2] / turn, 0.03}}};
  MatrixXd powers(3, 3);
  VectorXd twice(3);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) powers(i, j) = std::pow(w[i] / w[1], 2 * j - 1);
    twice[i] = 2.0 * law.anchors[i].ratio;
  }
  const VectorXd a = powers.fullPivLu().solve(twice);
  for (int i = 3; i < 6; ++i) {
    double ratio = 0.0;
    for (int j = 0; j < 3; ++j) ratio += 0.5 * a[j] * std::pow(w[i] / w[1], 2 * j - 1);
    EXPECT_NEAR(damping_ratios(law, w)[i] / ratio, 1.0, 1e-12);
  }
}

TEST(CaugheyDamping, WithTwoAnchorsIsRayleighs) {
  const VectorXd omega = VectorXd::LinSpaced(20, 1.0, 900.0);
  const fem::DampingAnchor first{4.0, 0.01}, second{60.0, 0.02};
  EXPECT_EQ(damping_ratios(fem::CaugheyDamping{{first, second}}, omega),
            damping_ratios(fem::RayleighDamping{first, second}, omega));
  EXPECT_NO_THROW(proportional_coefficients(fem::CaugheyDamping{{first, second}}));
  EXPECT_EQ(proportional_coefficients(fem::CaugheyDamping{{first}}).stiffness, 0.0);
}

TEST(CaugheyDamping, NamesTheModeThatWouldGainEnergy) {
  // Three anchors with a peak in the middle: the parabola in omega^2 falls below zero beyond them.
  const fem::CaugheyDamping law{{{1.0, 0.01}, {10.0, 0.05}, {20.0, 0.01}}};
  const VectorXd omega{{turn * 5.0, turn * 60.0}};
  EXPECT_THAT(message(law, omega),
              testing::StartsWith("caughey damping: mode 2 at 60 Hz would have the damping ratio -"));
}

TEST(StructuralDamping, IsHalfItsLossFactorAtResonance) {
  EXPECT_EQ(damping_ratios(fem::StructuralDamping{0.02}, VectorXd::Ones(3)), VectorXd::Constant(3, 0.01));
  EXPECT_THROW(damping_rates(fem::StructuralDamping{0.02}, VectorXd::Ones(3)), std::invalid_argument);
}

TEST(Damping, SaysWhatIsWrongWithALaw) {
  const VectorXd omega = VectorXd::Ones(2);
  EXPECT_EQ(message(fem::ModalDamping{{}}, omega), "modal damping has no ratios; expected at least 1");
  EXPECT_EQ(message(fem::ModalDamping{{0.1, -0.2}}, omega),
            "modal damping: ratio 2 is -0.2; expected a finite number of at least 0");
  EXPECT_EQ(message(fem::RayleighDamping{{3.0, 0.1}, {3.0, 0.2}}, omega),
            "rayleigh damping: anchor 2: frequency is 3; expected another one than before");
  EXPECT_EQ(message(fem::RayleighDamping{{0.0, 0.1}, {3.0, 0.2}}, omega),
            "rayleigh damping: anchor 1: frequency is 0; expected a finite number of Hz above 0");
  EXPECT_EQ(message(fem::CaugheyDamping{}, omega), "caughey damping has no anchors; expected at least 1");
  EXPECT_THAT(message(fem::StructuralDamping{-1.0}, omega), testing::HasSubstr("loss factor is -1"));
}

TEST(Damping, RefusesAMatrixThatWouldBeFull) {
  EXPECT_THROW(proportional_coefficients(fem::ModalDamping{{0.01}}), std::invalid_argument);
  EXPECT_THROW(proportional_coefficients(fem::StructuralDamping{0.01}), std::invalid_argument);
  EXPECT_THROW(proportional_coefficients(fem::CaugheyDamping{{{1, 0.1}, {2, 0.1}, {3, 0.1}}}),
               std::invalid_argument);
  EXPECT_EQ(proportional_damping(fem::Undamped{}, assemble(test::steel_beam(0.0), 3)).nonZeros(), 0);
}

}  // namespace
}  // namespace beamid::damping_test
