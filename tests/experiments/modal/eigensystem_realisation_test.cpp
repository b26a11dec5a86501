#include "experiments/modal/subspace_realisation.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "tests/experiments/damped_oscillation.hpp"

namespace beamid::experiments::eigensystem_realisation_test {
namespace {

using Complex = std::complex<double>;
using test::complex_rate, test::damped_oscillation;

std::vector<IdentifiedMode> physical(const EigensystemRealisation& result) {
  std::vector<IdentifiedMode> modes;
  for (const IdentifiedMode& mode : result.modes)
    if (!mode.spurious) modes.push_back(mode);
  return modes;
}

// Oracle: the sines put in.
TEST(EigensystemRealisation, RecoversOneToThreeExactDecays) {
  const double interval = 0.01;
  const double frequency[] = {2.1, 7.5, 13.2}, damping[] = {0.002, 0.01, 0.03};
  const Complex amplitude[] = {{1, 0.2}, {-0.4, 0.5}, {0.1, 0.3}};
  Eigen::VectorXd signal = Eigen::VectorXd::Zero(800);
  for (int count = 1; count <= 3; ++count) {
    signal += damped_oscillation(amplitude[count - 1], complex_rate(frequency[count - 1], damping[count - 1]),
                                 interval, 800);
    const EigensystemRealisation result = eigensystem_realisation(signal.transpose(), interval);
    const std::vector<IdentifiedMode> modes = physical(result);
    EXPECT_EQ(result.order, 2 * count);
    ASSERT_EQ(static_cast<int>(modes.size()), count);
    for (int m = 0; m < count; ++m) {
      EXPECT_NEAR(modes[m].frequency_hz / frequency[m], 1, 1e-10);
      EXPECT_NEAR(modes[m].damping_ratio / damping[m], 1, 1e-8);
      EXPECT_NEAR(std::abs(modes[m].shape[0] - amplitude[m]), 0, 1e-9);
      EXPECT_NEAR(modes[m].phase(), std::arg(amplitude[m]), 1e-8);
    }
    EXPECT_LT(result.residual_standard_deviation[0], 1e-10);
  }
}

// Oracle: two modes seen by three sensors through known complex shapes.
TEST(EigensystemRealisation, FindsTheShapesOfSeveralOutputs) {
  const double interval = 0.005;
  const Complex first = complex_rate(3, 0.005), second = complex_rate(19, 0.01);
  Eigen::Matrix<Complex, 3, 2> shapes;
  shapes << Complex(1, 0), Complex(0.5, 0.1), Complex(0.6, 0.1), Complex(-1, 0), Complex(0.2, 0),
      Complex(0, 0.8);
  Eigen::MatrixXd outputs(3, 500);
  for (int i = 0; i < 3; ++i)
    outputs.row(i) = (damped_oscillation(shapes(i, 0), first, interval, 500) +
                      damped_oscillation(shapes(i, 1), second, interval, 500))
                         .transpose();
  const EigensystemRealisation result = eigensystem_realisation(outputs, interval);
  const std::vector<IdentifiedMode> modes = physical(result);
  ASSERT_EQ(modes.size(), 2);
  EXPECT_NEAR(std::abs(modes[0].rate - first), 0, 1e-7);
  EXPECT_NEAR(std::abs(modes[1].rate - second), 0, 1e-7);
  EXPECT_LT((modes[0].shape - shapes.col(0)).norm(), 1e-8);
  EXPECT_LT((modes[1].shape - shapes.col(1)).norm(), 1e-8);
  EXPECT_LT((result.reconstruction - outputs).cwiseAbs().maxCoeff(), 1e-9);
}

/// Cramer-Rao standard deviations of angular frequency and damping rate, amplitude and phase unknown.
Eigen::Vector2d cramer_rao(Complex amplitude, Complex rate, double interval, Eigen::Index count,
                           double noise) {
  Eigen::MatrixXd jacobian(count, 4);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double time = interval * static_cast<double>(k);
    const Complex unit = std::exp(rate * time), value = amplitude * unit;
    jacobian.row(k) << -time * value.imag(), -time * value.real(), unit.real(), -unit.imag();
  }
  const Eigen::Matrix4d covariance = (jacobian.transpose() * jacobian).inverse() * noise * noise;
  return covariance.diagonal().head<2>().cwiseSqrt();
}

// Oracle: the Cramer-Rao bound, over 200 seeded records; the order is left to the method.
TEST(EigensystemRealisation, ComesCloseToTheCramerRaoBound) {
  const double interval = 0.01, noise = 0.05;
  const Eigen::Index count = 500;
  const Complex rate = complex_rate(6, 0.005), amplitude(0.8, 0.6);
  const Eigen::VectorXd clean = damped_oscillation(amplitude, rate, interval, count);
  std::mt19937_64 generator(11);
  std::normal_distribution<double> normal(0, noise);
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  constexpr int runs = 200;
  for (int run = 0; run < runs; ++run) {
    const Eigen::VectorXd noisy =
        clean + Eigen::VectorXd::NullaryExpr(count, [&] { return normal(generator); });
    const EigensystemRealisation result = eigensystem_realisation(noisy.transpose(), interval);
    const IdentifiedMode* best = nullptr;
    for (const IdentifiedMode& mode : result.modes)
      if (!best || std::abs(mode.rate - rate) < std::abs(best->rate - rate)) best = &mode;
    ASSERT_NE(best, nullptr);
    EXPECT_NEAR(result.residual_standard_deviation[0], noise, 0.2 * noise);
    const Complex error = best->rate - rate;
    squares += Eigen::Vector2d(error.imag(), error.real()).cwiseAbs2() / runs;
  }
  const Eigen::Vector2d ratio =
      squares.cwiseSqrt().cwiseQuotient(cramer_rao(amplitude, rate, interval, count, noise));
  RecordProperty("rms_over_bound_frequency", std::to_string(ratio[0]));
  RecordProperty("rms_over_bound_damping", std::to_string(ratio[1]));
  EXPECT_LT(ratio[0], 1.3);
  EXPECT_LT(ratio[1], 1.3);
  EXPECT_GT(ratio.minCoeff(), 0.8);
}

// A constant is a pole at zero, a growing sine has negative damping: neither is a mode of a free decay.
TEST(EigensystemRealisation, MarksSpuriousPoles) {
  const double interval = 0.01;
  Eigen::VectorXd signal = damped_oscillation(1, complex_rate(5, 0.01), interval, 600) +
                           damped_oscillation(0.3, complex_rate(12, -0.001), interval, 600) +
                           damped_oscillation(1e-4, complex_rate(20, 0.01), interval, 600);
  signal.array() += 0.5;
  const EigensystemRealisation result = eigensystem_realisation(signal.transpose(), interval);
  ASSERT_EQ(result.modes.size(), 4);
  const bool spurious[] = {true, false, true, true};
  const double frequency[] = {0, 5, 12, 20};
  for (int m = 0; m < 4; ++m) {
    EXPECT_EQ(result.modes[m].spurious, spurious[m]) << m;
    EXPECT_NEAR(result.modes[m].frequency_hz, frequency[m], 1e-4);
  }
  EXPECT_NEAR(result.modes[0].shape[0].real(), 0.5, 1e-8);
  EXPECT_NEAR(result.modes[2].amplitude(), 0.3, 1e-8);
}

TEST(EigensystemRealisation, RefusesWhatItCannotAnalyse) {
  const Eigen::MatrixXd signal = damped_oscillation(1, complex_rate(5, 0.01), 0.01, 100).transpose();
  EXPECT_THROW(eigensystem_realisation(signal.leftCols(8), 0.01), std::invalid_argument);
  EXPECT_THROW(eigensystem_realisation(signal, 0), std::invalid_argument);
  EXPECT_THROW(eigensystem_realisation(Eigen::MatrixXd::Zero(1, 100), 0.01), std::invalid_argument);
  EXPECT_THROW(eigensystem_realisation(signal * std::nan(""), 0.01), std::invalid_argument);
  EXPECT_THROW(eigensystem_realisation(signal * 1e200, 0.01), std::invalid_argument);
  EXPECT_THROW(eigensystem_realisation(signal * 1e-200, 0.01), std::invalid_argument);
  EigensystemSettings settings;
  settings.rows = 60;
  EXPECT_THROW(eigensystem_realisation(signal, 0.01, settings), std::invalid_argument);
  settings = {};
  settings.order = 50;
  EXPECT_THROW(eigensystem_realisation(signal, 0.01, settings), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::eigensystem_realisation_test
