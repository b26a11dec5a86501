// Bayes' fast Fourier method on modes that are known.
#include "experiments/modal/ambient_mode.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/modal/modal_method.hpp"
#include "experiments/signal/random.hpp"
#include "tests/experiments/modal/shaken_chain.hpp"

namespace beamid::experiments::ambient_mode_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

TEST(AmbientLaw, HasThePublishedValues) {
  // Oracle: zeta 1 %, 1000 periods, kappa 10: 0.135 % and 14.8 %.
  const AmbientLaw law = ambient_law(0.01, 1000.0, 10.0);
  EXPECT_NEAR(100.0 * law.frequency, 0.135, 5e-4);
  EXPECT_NEAR(100.0 * law.damping, 14.8, 0.05);
}

// x'' + 2 zeta w x' + w^2 x = white noise, its displacement, sampled exactly: [x, x'] moves by e^(A dt).
VectorXd shaken(double frequency, double zeta, double dt, Index samples, filters::RandomStream& random) {
  const double w = 2.0 * std::numbers::pi * frequency, wd = w * std::sqrt(1.0 - zeta * zeta);
  constexpr Index fine = 8;
  const double h = dt / fine, decay = std::exp(-zeta * w * h), c = std::cos(wd * h),
               s = std::sin(wd * h) / wd;
  const double a11 = decay * (c + zeta * w * s), a12 = decay * s, a21 = -decay * w * w * s,
               a22 = decay * (c - zeta * w * s);
  double x = 0.0, v = 0.0;
  VectorXd y(samples);
  const Index quiet = static_cast<Index>(3.0 / (zeta * w * dt));
  for (Index k = -quiet; k < samples; ++k) {
    const VectorXd f = random.normal(fine, 1);

    for (Index j = 0; j < fine; ++j) {
      const double next = a11 * x + a12 * v;
      v = a21 * x + a22 * v + f[j];
      x = next;
    }

    if (k >= 0) y[k] = x;
  }
  return y;
}

TEST(AmbientMode, ScattersAsTheLawAndItsOwnDeviationsSay) {
  // Oracle: the law of long records, and the scatter over 300 seeds, which is known to 4 %.
  constexpr int runs = 300;
  constexpr double f = 1.0, zeta = 0.01, dt = 0.2;
  constexpr Index samples = 5000;  // 1000 periods
  VectorXd frequency(runs), damping(runs), own_frequency(runs), own_damping(runs);
  for (int run = 0; run < runs; ++run) {
    filters::RandomStream random(7, static_cast<std::uint64_t>(run));
    const VectorXd y = shaken(f, zeta, dt, samples, random);
    MatrixXd channels(2, samples);  // the noise shows where the mode does not: across its shape
    channels << y.transpose(), 0.6 * y.transpose();
    channels += 0.05 * std::sqrt(y.squaredNorm() / samples) * random.normal(2, samples);
    const BandCoefficients all = fourier_coefficients(channels, dt);
    const AmbientMode mode =
        ambient_mode(within(all, {0.9 * f, 1.1 * f}), f, 0.012, ResponseKind::displacement);
    ASSERT_TRUE(mode.converged) << run;
    frequency[run] = mode.frequency_hz / f - 1.0;
    damping[run] = mode.damping_ratio / zeta - 1.0;
    own_frequency[run] = mode.frequency_deviation_hz / f;
    own_damping[run] = mode.damping_ratio_deviation / zeta;
  }
  const AmbientLaw law = ambient_law(zeta, 1000.0, 10.0);
  const auto scatter = [](const VectorXd& values) {
    return std::sqrt((values.array() - values.mean()).square().sum() / (runs - 1));
  };
  EXPECT_NEAR(scatter(frequency) / law.frequency, 1.0, 0.12);
  EXPECT_NEAR(scatter(damping) / law.damping, 1.0, 0.12);
  EXPECT_NEAR(own_frequency.mean() / law.frequency, 1.0, 0.05);
  EXPECT_NEAR(own_damping.mean() / law.damping, 1.0, 0.05);
  EXPECT_NEAR(frequency.mean(), 0.0, 3.3 * scatter(frequency) / std::sqrt(runs));
}

TEST(Bayoma, FindsTheModesOfAChainWithTheirShapes) {
  // Oracle: the chain's own modes, within 3.5 of the deviations reported.
  const test::ShakenChain chain;
  const auto method = modal_method_registry().make("bayoma", {{"response", std::string("displacement")}});
  const PoleSearch found = method->search(chain.record(20000, 3), chain.interval, 0);
  ASSERT_EQ(found.orders.at(0).poles.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const Pole& pole = found.orders[0].poles[i];
    const auto truth = chain.modes()[i];
    EXPECT_NEAR(pole.frequency_hz(), truth.frequency_hz, 3.5 * pole.frequency_deviation_hz);
    EXPECT_NEAR(pole.damping_ratio(), truth.damping_ratio, 3.5 * pole.damping_ratio_deviation);
    EXPECT_NEAR(pole.shape.cwiseAbs().minCoeff() / pole.shape.cwiseAbs().maxCoeff(), truth.shape_ratio, 0.03);
  }
}

TEST(Bayoma, NamesWhatItRefuses) {
  const auto method = modal_method_registry().make("bayoma", {});
  EXPECT_THROW(method->search(MatrixXd::Random(1, 100), 0.1, 0), std::invalid_argument);
  EXPECT_THROW(modal_method_registry().make("bayoma", {{"response", std::string("speed")}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::ambient_mode_test
