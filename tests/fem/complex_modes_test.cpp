#include "fem/complex_modes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "fem/assembly.hpp"
#include "fem/exact/exact_cantilever.hpp"
#include "fem/modes.hpp"
#include "fem/structural_system.hpp"
#include "tests/fem/five_beams.hpp"
#include "tests/fem/response/oscillator_system.hpp"

namespace beamid::complex_modes_test {
namespace {

using Complex = std::complex<double>;

fem::Beam beam_with_tip_dashpot(double tip_mass, double dashpot) {
  fem::Beam beam = test::steel_beam(tip_mass);
  beam.dashpots = {{beam.length(), dashpot, 0.0, 0.0}};
  return beam;
}

// EI W'''' + (m / L) lambda^2 W = 0, m the beam's mass, W(0) = W'(0) = W''(L) = 0, EI W'''(L) = (M lambda^2 +
// c lambda) W(L). With lambda = i b^2 w0, w0 = sqrt(EI / (m L^3)) (docs/theory/response.md), and the shape
// cosh - cos - sigma (sinh - sin) the last condition becomes
//
//     1 + cos b cosh b - Z (cos b sinh b - sin b cosh b) = 0,     Z = (M lambda^2 + c lambda) L^3 / (EI b^3).
//
// Solved by Newton's method for complex b with a central difference, from `lambda` on.
Complex exact_eigenvalue(const fem::Cantilever& beam, double dashpot, Complex lambda) {
  const double l3 = std::pow(beam.length, 3), ei = beam.bending_stiffness;
  const double w0 = std::sqrt(ei / (beam.mass() * l3));
  const Complex i(0.0, 1.0);
  const auto residual = [&](Complex b) {
    const Complex rate = i * b * b * w0,
                  z = (beam.tip_mass * rate * rate + dashpot * rate) * l3 / (ei * b * b * b);
    return 1.0 + std::cos(b) * std::cosh(b) - z * (std::cos(b) * std::sinh(b) - std::sin(b) * std::cosh(b));
  };
  Complex b = std::sqrt(lambda / (i * w0));
  for (int step = 0; step < 50; ++step) {
    const double h =
        1e-4;  // the difference is good to h^4: Newton then converges by a factor 1e-9 per step at least
    const Complex slope =
        (8.0 * (residual(b + h) - residual(b - h)) - residual(b + 2 * h) + residual(b - 2 * h)) / (12 * h);
    const Complex change = residual(b) / slope;
    b -= change;
    if (std::abs(change) < 1e-15 * std::abs(b)) break;
  }
  return i * b * b * w0;
}

TEST(ComplexModes, OfOneOscillatorAreTheRootsOfItsQuadratic) {
  // Oracle: m l^2 + c l + k = 0.
  const auto light = complex_modes(test::oscillator(2.0, 800.0, 4.0), 1);
  EXPECT_NEAR(std::abs(light.eigenvalue[0] - Complex(-1.0, std::sqrt(399.0))), 0.0, 1e-13);
  EXPECT_NEAR(light.damping_ratio()[0], 0.05, 1e-15);
  EXPECT_NEAR(light.frequency_hz()[0], 20.0 / (2 * M_PI), 1e-14);
  const auto heavy = complex_modes(test::oscillator(2.0, 800.0, 100.0), 1);
  EXPECT_NEAR(std::abs(heavy.eigenvalue[0] - Complex(-10.0, 0.0)), 0.0,
              1e-12);  // the slower one of -10 and -40
  EXPECT_EQ(heavy.damping_ratio()[0], 1.0);
  EXPECT_EQ(heavy.damped_frequency_hz()[0], 0.0);
}

TEST(ComplexModes, OverdampedMotionsCountOneByOne) {
  // Oracle: two oscillators that do not know of each other, one with the real roots -10 and -40, one with -1
  // +- 30 i.
  auto system = test::chain({1.0, 1.0}, {1.0, 1.0}, {0.0, 0.0});
  system.stiffness.strain = test::sparse(Eigen::MatrixXd::Identity(2, 2));
  system.stiffness.rigidity = test::sparse(Eigen::Vector2d(400.0, 901.0).asDiagonal().toDenseMatrix());
  system.stiffness.flexibility =
      test::sparse(Eigen::Vector2d(1 / 400.0, 1 / 901.0).asDiagonal().toDenseMatrix());
  system.damping = test::sparse(Eigen::Vector2d(50.0, 2.0).asDiagonal().toDenseMatrix());
  const auto modes = complex_modes(system, 2);
  ASSERT_EQ(modes.size(), 2);
  EXPECT_NEAR(std::abs(modes.eigenvalue[0] - Complex(-10.0, 0.0)), 0.0, 1e-12);
  EXPECT_NEAR(std::abs(modes.eigenvalue[1] - Complex(-1.0, 30.0)), 0.0, 1e-12);
}

TEST(ComplexModes, TipDashpotGivesTheRootsOfTheContinuum) {
  // Oracle: the complex characteristic equation above; 80 elements err by (b h / L)^4 / 1440 in frequency.
  for (const double tip_mass : {0.0, 0.36049})
    for (const double dashpot : {0.5, 5.0, 20.0}) {
      const fem::Cantilever bare = test::steel_beam(tip_mass);
      const auto modes = complex_modes(assemble(beam_with_tip_dashpot(tip_mass, dashpot), 80), 4);
      for (int i = 0; i < 4; ++i) {
        const Complex exact = exact_eigenvalue(bare, dashpot, modes.eigenvalue[i]);
        const double b = std::sqrt(std::abs(exact) / fem::ExactMode(bare, 1).angular_frequency()) *
                         fem::ExactMode(bare, 1).root();
        EXPECT_LT(std::abs(modes.eigenvalue[i] - exact) / std::abs(exact), 2e-11 + std::pow(b / 80, 4) / 1000)
            << tip_mass << " kg, " << dashpot << " N s/m, mode " << i + 1;
        EXPECT_LT(modes.residual[i], 1e-9);
      }
    }
}

TEST(ComplexModes, LightTipDashpotStartsFromTheUndampedModes) {
  // Oracle: the same equation, followed from the undamped root without the finite elements.
  const fem::Cantilever bare = test::steel_beam(0.36049);
  const auto modes = complex_modes(assemble(beam_with_tip_dashpot(0.36049, 0.5), 80), 3);
  for (int i = 0; i < 3; ++i) {
    const Complex undamped(0.0, fem::ExactMode(bare, i + 1).angular_frequency());
    const Complex exact = exact_eigenvalue(bare, 0.5, undamped);
    EXPECT_LT(std::abs(modes.eigenvalue[i] - exact) / std::abs(exact), 2e-7);
    EXPECT_NEAR(modes.damping_ratio()[i], -exact.real() / std::abs(exact), 1e-8);
  }
}

TEST(ComplexModes, ProportionalDampingKeepsTheRealModes) {
  // Oracle: lambda = -xi w + i w sqrt(1 - xi^2) of the undamped modes.
  auto system = assemble(test::steel_beam(1.33809), 60);
  const auto real = fem::modes(system, 5);
  const fem::RayleighDamping law{{2.0, 0.02}, {50.0, 0.02}};
  system.damping = proportional_damping(law, system);
  const auto modes = complex_modes(system, 5);
  const Eigen::VectorXd xi = damping_ratios(law, real.angular_frequency);
  for (int i = 0; i < 5; ++i) {
    const double w = real.angular_frequency[i];
    const Complex expected(-xi[i] * w, w * std::sqrt(1 - xi[i] * xi[i]));
    EXPECT_LT(std::abs(modes.eigenvalue[i] - expected) / w, 1e-8) << "mode " << i + 1;  // K in C is assembled
    EXPECT_NEAR(std::abs(modes.shape.col(i).dot(system.mass * real.shape.col(i))), 1.0, 1e-8);
  }
}

TEST(ComplexModes, ArnoldiAndDenseEigenvaluesAgree) {
  const auto system = assemble(beam_with_tip_dashpot(0.36049, 5.0), 40);
  const auto few = complex_modes(system, 5), many = complex_modes(system, 60);
  for (int i = 0; i < 5; ++i)
    EXPECT_LT(std::abs(few.eigenvalue[i] - many.eigenvalue[i]) / std::abs(many.eigenvalue[i]), 1e-12);
}

TEST(ComplexModes, WithoutDashpotsAreTheModes) {
  const auto system = assemble(test::steel_beam(0.36049), 1000);
  const auto real = fem::modes(system, 3);
  const auto modes = complex_modes(system, 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(modes.eigenvalue[i].imag() / real.angular_frequency[i], 1.0, 1e-11);
    EXPECT_NEAR(modes.damping_ratio()[i], 0.0, 1e-12);
  }
}

TEST(ComplexModes, RefuseMechanismsAndImpossibleCounts) {
  const auto system = assemble(test::steel_beam(0.0), 3);
  EXPECT_THROW(complex_modes(system, 0), std::invalid_argument);
  EXPECT_THROW(complex_modes(system, 7), std::invalid_argument);
  fem::Beam free = test::steel_beam(0.0);
  free.supports.clear();
  EXPECT_THROW(complex_modes(assemble(free, 3), 2), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::complex_modes_test
