// Bayes' fast Fourier method on modes that are known.
#include "experiments/modal/ambient_mode.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "experiments/modal/modal_method.hpp"
#include "experiments/signal/toolbox.hpp"
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

/// Of the estimates of many records, relative to the law of long ones.
struct Scatter {
  double frequency = 0.0, damping = 0.0;          ///< rms about the mean
  double own_frequency = 0.0, own_damping = 0.0;  ///< mean of what each reports
  double bias = 0.0;                              ///< of the frequency, in standard errors
};

Scatter scatter_over_law(double periods, int runs) {
  constexpr double f = 1.0, zeta = 0.01, dt = 0.2;
  const auto samples = static_cast<Index>(periods / (f * dt));
  VectorXd frequency(runs), damping(runs);
  Scatter result;
  const AmbientLaw law = ambient_law(zeta, periods, 10.0);
  for (int run = 0; run < runs; ++run) {
    filters::RandomStream random(7, static_cast<std::uint64_t>(run));
    const VectorXd y = shaken(f, zeta, dt, samples, random);
    MatrixXd channels(2, samples);  // the noise shows where the mode does not: across its shape
    channels << y.transpose(), 0.6 * y.transpose();
    channels += 0.05 * std::sqrt(y.squaredNorm() / static_cast<double>(samples)) * random.normal(2, samples);
    const BandCoefficients all = fourier_coefficients(channels, dt);
    const AmbientMode mode =
        ambient_mode(within(all, {0.9 * f, 1.1 * f}), f, 0.012, ResponseKind::displacement);
    EXPECT_TRUE(mode.converged) << run;
    frequency[run] = mode.frequency_hz / f - 1.0;
    damping[run] = mode.damping_ratio / zeta - 1.0;
    result.own_frequency += mode.frequency_deviation_hz / f / law.frequency / runs;
    result.own_damping += mode.damping_ratio_deviation / zeta / law.damping / runs;
  }
  const auto rms = [runs](const VectorXd& values) {
    return std::sqrt((values.array() - values.mean()).square().sum() / (runs - 1));
  };
  result.frequency = rms(frequency) / law.frequency;
  result.damping = rms(damping) / law.damping;
  result.bias = frequency.mean() / (rms(frequency) / std::sqrt(runs));
  return result;
}

TEST(AmbientMode, ScattersAsTheLawAndItsOwnDeviationsSay) {
  // Oracle: the law of long records, and the scatter over 300 seeds, which is known to 4 %.
  const Scatter found = scatter_over_law(1000.0, 300);
  EXPECT_NEAR(found.frequency, 1.0, 0.12);
  EXPECT_NEAR(found.damping, 1.0, 0.12);
  EXPECT_NEAR(found.own_frequency, 1.0, 0.05);
  EXPECT_NEAR(found.own_damping, 1.0, 0.05);
  EXPECT_LT(std::abs(found.bias), 3.3);
}

// With BEAMID_LONG_AMBIENT: 1,000 seeds know the scatter to 2.2 %. A damping known to 15 %, of 1,000 periods,
// is not in the range where the law is exact; one known to 5 % is.
TEST(AmbientMode, ScattersAsTheLawMoreNearlyInLongerRecords) {
  if (std::getenv("BEAMID_LONG_AMBIENT") == nullptr) GTEST_SKIP() << "BEAMID_LONG_AMBIENT asks for it";
  for (const double periods : {1000.0, 3000.0, 9000.0}) {
    const Scatter found = scatter_over_law(periods, 1000);
    std::printf(
        "%.0f periods: scatter / law of the frequency %.3f, of the damping %.3f; own deviations %.3f, %.3f\n",
        periods, found.frequency, found.damping, found.own_frequency, found.own_damping);
    EXPECT_NEAR(found.frequency, 1.0, 0.06);
    EXPECT_NEAR(found.damping, 1.0, periods > 1000.0 ? 0.06 : 0.1);
  }
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

/// Poles of `bayoma` in a record (p x N) of displacements.
std::vector<Pole> listed(const MatrixXd& channels, double dt) {
  const auto method = modal_method_registry().make("bayoma", {{"response", std::string("displacement")}});
  return method->search(channels, dt, 0).orders.back().poles;
}

// 600 s of two modes of 1 % damping, 0.5 to 5 % apart, on two channels. Oracle: the structure that was
// shaken.
TEST(AmbientPair, IsTwoModesWhereTheBandHasTwo) {
  constexpr double f = 5.0, zeta = 0.01, dt = 0.05;
  constexpr Index samples = 12000;
  int inside = 0, asked = 0, refused = 0;
  for (const double apart : {0.005, 0.01, 0.02, 0.05})
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
      filters::RandomStream random(11, seed);
      const VectorXd a = shaken(f, zeta, dt, samples, random),
                     b = shaken((1.0 + apart) * f, zeta, dt, samples, random);
      MatrixXd channels(2, samples);
      channels << (a + b).transpose(), (a - 0.7 * b).transpose();
      channels += 0.02 * a.norm() / std::sqrt(static_cast<double>(samples)) * random.normal(2, samples);
      const std::vector<Pole> poles = listed(channels, dt);
      if (poles.empty()) {  // refused, which is no wrong answer
        ++refused;
        continue;
      }
      ASSERT_EQ(poles.size(), 2u) << apart << " " << seed;
      for (int i = 0; i < 2; ++i) {
        const Pole& pole = poles[static_cast<std::size_t>(i)];
        const double true_hz = i == 0 ? f : (1.0 + apart) * f,
                     by_frequency = std::abs(pole.frequency_hz() - true_hz) / pole.frequency_deviation_hz,
                     by_damping = std::abs(pole.damping_ratio() - zeta) / pole.damping_ratio_deviation;
        EXPECT_LT(by_frequency, 4.0) << apart << " " << seed;
        EXPECT_LT(by_damping, 4.0) << apart << " " << seed;
        inside += (by_frequency < 1.96) + (by_damping < 1.96), asked += 2;
      }
    }
  EXPECT_LE(refused, 2);         // at 5 % apart, where the bands of the two peaks overlap in part
  EXPECT_GE(inside, asked - 7);  // 48 intervals of 95 %: more than 7 outside by chance in one of 300
}

// One mode, whose channels have unequal noise, which a single mode's spectrum does not describe.
TEST(AmbientPair, IsNotSeenWhereThereIsOneMode) {
  constexpr double f = 5.0, zeta = 0.01, dt = 0.05;
  constexpr Index samples = 12000;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    filters::RandomStream random(12, seed);
    const VectorXd a = shaken(f, zeta, dt, samples, random);
    MatrixXd channels(3, samples);
    channels << a.transpose(), a.transpose(), 0.5 * a.transpose();
    MatrixXd noise = random.normal(3, samples);
    noise.row(2) *= 0.5;
    channels += 0.02 * a.norm() / std::sqrt(static_cast<double>(samples)) * noise;
    const std::vector<Pole> poles = listed(channels, dt);
    ASSERT_EQ(poles.size(), 1u) << seed;
    EXPECT_LT(std::abs(poles[0].damping_ratio() - zeta), 4.0 * poles[0].damping_ratio_deviation) << seed;
  }
}

}  // namespace
}  // namespace beamid::experiments::ambient_mode_test
