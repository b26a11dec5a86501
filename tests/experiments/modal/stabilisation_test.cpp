// Reading stabilisation diagrams, and all modes of a decay by least squares.
#include "experiments/modal/poles.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "experiments/modal/dominant_mode.hpp"
#include "experiments/modal/joint_decay_fit.hpp"
#include "experiments/modal/modal_method.hpp"
#include "experiments/modal/subspace_realisation.hpp"
#include "experiments/signal/toolbox.hpp"
#include "tests/experiments/damped_oscillation.hpp"
#include "tests/experiments/modal/shaken_chain.hpp"

namespace beamid::experiments::stabilisation_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using Complex = std::complex<double>;
using test::complex_rate, testing::HasSubstr;

Pole pole_at(double frequency_hz, double damping_ratio) {
  return {complex_rate(frequency_hz, damping_ratio), Eigen::VectorXcd::Ones(1)};
}

/// Two decays, 5 and 8 Hz, in two channels, with white noise.
MatrixXd noisy_decay(double noise, std::uint64_t seed) {
  MatrixXd outputs = MatrixXd::Zero(2, 400);
  for (Index k = 0; k < outputs.cols(); ++k) {
    const double t = 0.01 * static_cast<double>(k);
    const Complex a = std::exp(complex_rate(5, 0.01) * t), b = 0.5 * std::exp(complex_rate(8, 0.02) * t);
    outputs(0, k) = 0.3 + a.real() + b.real();
    outputs(1, k) = 0.6 * a.real() - b.imag();
  }
  for (Index i = 0; i < 2; ++i)
    outputs.row(i) += noise * standard_normal(outputs.cols(), seed, 7 + i).transpose();
  return outputs;
}

// Oracle: what was put into the diagram.
TEST(Stabilise, ChoosesWhatStaysAndSaysWhyNotTheRest) {
  std::vector<OrderPoles> orders;
  for (int n = 2; n <= 20; n += 2) {
    const double drift = 1e-3 * n;
    OrderPoles at{n, {pole_at(5 + drift, 0.01), pole_at(9, -0.01), pole_at(12, 0.4)}};
    if (n > 16) at.poles.push_back(pole_at(20, 0.02));
    at.poles.push_back(pole_at(30 + 3 * n, 0.02));
    orders.push_back(at);
  }
  orders.back().poles.push_back(pole_at(20.01, 0.02));
  orders[7].poles.push_back(pole_at(20, 0.02));
  const Stabilisation found = stabilise(orders, {});
  ASSERT_EQ(found.modes.size(), 1);
  EXPECT_NEAR(found.modes[0].pole.frequency_hz(), 5.012, 1e-3);
  EXPECT_NEAR(found.modes[0].pole.damping_ratio(), 0.01, 1e-12);
  EXPECT_EQ(found.modes[0].orders.size(), 9);  // the first order has none before it
  ASSERT_EQ(found.rejected.size(), 3);
  EXPECT_THAT(found.rejected[0].objection, HasSubstr("negative damping ratio"));
  EXPECT_THAT(found.rejected[1].objection, HasSubstr("damping ratio 0.4, above 0.2"));
  EXPECT_THAT(found.rejected[2].objection, HasSubstr("stable at 2 of 10 orders, fewer than 3"));
}

TEST(Stabilise, LeavesOutWhatIsTooUncertain) {
  std::vector<OrderPoles> orders;
  for (int n = 2; n <= 12; n += 2) {
    Pole sure = pole_at(5, 0.01), unsure = pole_at(9, 0.01);
    sure.frequency_deviation_hz = 0.01, sure.damping_ratio_deviation = 0.001;
    unsure.frequency_deviation_hz = 0.5, unsure.damping_ratio_deviation = 0.01;
    orders.push_back({n, {sure, unsure}});
  }
  const Stabilisation found = stabilise(orders, {});
  ASSERT_EQ(found.modes.size(), 1);
  EXPECT_NEAR(found.modes[0].pole.frequency_deviation_hz, 0.01, 1e-12);  // more orders know no more
  ASSERT_EQ(found.rejected.size(), 1);
  EXPECT_THAT(found.rejected[0].objection, HasSubstr("too uncertain"));
}

// Oracle: the realisation at one order.
TEST(Realisations, OfAllOrdersAreThoseOfEachOrder) {
  const MatrixXd outputs = noisy_decay(0.02, 9);
  const auto all = eigensystem_realisations(outputs, 0.01, 8);
  ASSERT_EQ(all.size(), 4);
  for (const EigensystemRealisation& one : all) {
    EigensystemSettings settings;
    settings.order = one.order;
    const auto alone = eigensystem_realisation(outputs, 0.01, settings);
    ASSERT_EQ(one.modes.size(), alone.modes.size());
    for (std::size_t m = 0; m < alone.modes.size(); ++m) EXPECT_EQ(one.modes[m].rate, alone.modes[m].rate);
  }
}

// Oracle: each method on data of its own kind, the same chain: its free decay, and its random vibration.
TEST(Methods, AgreeOnDecayAndRandomVibration) {
  const test::ShakenChain chain;
  MatrixXd decay = MatrixXd::Zero(2, 500);
  for (const auto& mode : chain.modes())
    for (Index k = 0; k < decay.cols(); ++k) {
      const double part = std::exp(complex_rate(mode.frequency_hz, mode.damping_ratio) * chain.interval *
                                   static_cast<double>(k))
                              .real();
      decay(0, k) += part;
      decay(1, k) += (mode.frequency_hz < 1.5 ? 0.6 : -0.6) * part;
    }
  for (Index i = 0; i < 2; ++i) decay.row(i) += 0.01 * standard_normal(decay.cols(), 3, i).transpose();
  const auto modes_by = [&](const char* name, const MatrixXd& outputs) {
    return stabilise(modal_method_registry().make(name, {})->search(outputs, chain.interval, 20).orders, {})
        .modes;
  };
  auto by_era = modes_by("era", decay);
  std::erase_if(by_era, [](const PoleCluster& mode) { return mode.pole.shape.norm() < 0.05; });  // noise
  const auto by_ssi = modes_by("ssi_cov", chain.record(20000, 11));
  ASSERT_EQ(by_era.size(), 2);
  ASSERT_EQ(by_ssi.size(), 2);
  for (std::size_t m = 0; m < 2; ++m) {
    const auto truth = chain.modes()[m];
    const Pole &a = by_era[m].pole, &b = by_ssi[m].pole;
    EXPECT_NEAR(a.frequency_hz(), truth.frequency_hz, 1e-3 * truth.frequency_hz);
    EXPECT_NEAR(a.damping_ratio(), truth.damping_ratio, 0.05 * truth.damping_ratio);
    EXPECT_NEAR(b.frequency_hz(), a.frequency_hz(), 3.3 * b.frequency_deviation_hz);
    EXPECT_NEAR(b.damping_ratio(), a.damping_ratio(), 3.3 * b.damping_ratio_deviation);
    EXPECT_GT(modal_assurance(a.shape, b.shape), 0.99);
    EXPECT_GT(phase_collinearity(a.shape), 0.99);
  }
}

// Oracle: fit_damped_sines, which knows one channel and all its parameters at once.
TEST(JointDecayFit, IsTheFitOfDampedSinesInOneChannel) {
  const MatrixXd outputs = noisy_decay(0.02, 5).topRows(1);
  const std::vector<Complex> start{complex_rate(5.05, 0.02), complex_rate(7.9, 0.01)};
  const JointDecayFit joint = fit_decays_jointly(outputs, 0.01, start);
  const DampedSineFit one = fit_damped_sines(outputs.row(0).transpose(), 0.01, start);
  for (std::size_t m = 0; m < 2; ++m) {
    EXPECT_LT(std::abs(joint.rates[m] - one.sines[m].rate), 1e-7);
    EXPECT_LT(std::abs(joint.shapes(0, static_cast<Index>(m)) - one.sines[m].amplitude), 1e-7);
  }
  EXPECT_NEAR(joint.offsets[0], one.offset, 1e-9);
  EXPECT_NEAR(joint.residual_standard_deviation[0], one.residual_standard_deviation, 1e-9);
}

// Oracle: the truth, over seeded runs in white noise: unbiased, and as scattered as it says, within 3.3
// standard errors of a standard deviation over 100 runs (7 % each) and the error of a density from 17 lines.
TEST(JointDecayFit, KnowsItsOwnScatter) {
  constexpr int runs = 100;
  VectorXd frequency(runs), damping(runs);
  double frequency_variance = 0, damping_variance = 0;
  for (int run = 0; run < runs; ++run) {
    const JointDecayFit fit = fit_decays_jointly(noisy_decay(0.05, 100 + run), 0.01,
                                                 {complex_rate(5, 0.01), complex_rate(8, 0.02)});
    Pole pole{fit.rates[1], fit.shapes.col(1)};
    pole.take_deviations(fit.covariance.block<2, 2>(2, 2));
    frequency[run] = pole.frequency_hz();
    damping[run] = pole.damping_ratio();
    frequency_variance += std::pow(pole.frequency_deviation_hz, 2) / runs;
    damping_variance += std::pow(pole.damping_ratio_deviation, 2) / runs;
  }
  const auto scatter = [](const VectorXd& values) {
    return std::sqrt((values.array() - values.mean()).square().sum() / (runs - 1));
  };
  EXPECT_NEAR(std::sqrt(frequency_variance) / scatter(frequency), 1, 0.25);
  EXPECT_NEAR(std::sqrt(damping_variance) / scatter(damping), 1, 0.25);
  EXPECT_NEAR(frequency.mean(), 8, 0.33 * scatter(frequency));
  EXPECT_NEAR(damping.mean(), 0.02, 0.33 * scatter(damping));
}

// A second mode half a beat away, a tenth as large and damped four times as much: its valley is bent.
// Oracle: the truth, within four standard deviations.
TEST(JointDecayFit, FollowsABentValley) {
  constexpr Index count = 4000;
  constexpr double interval = 0.005;
  const Complex first = complex_rate(5.0, 0.00318), second = complex_rate(5.025, 0.01272);
  for (int seed = 1; seed <= 4; ++seed) {
    const VectorXd y = test::damped_oscillation(1.0, first, interval, count) +
                       test::damped_oscillation(Complex(0.08, 0.06), second, interval, count) +
                       0.001 * standard_normal(count, static_cast<std::uint64_t>(seed), 1);
    const Complex apart(0.0, 0.5 * std::numbers::pi / (interval * count));
    const JointDecayFit fit = fit_decays_jointly(y.transpose(), interval, {first - apart, first + apart});
    for (const Complex truth : {first, second}) {
      const std::size_t m = std::abs(fit.rates[0] - truth) < std::abs(fit.rates[1] - truth) ? 0 : 1;
      const auto at = static_cast<Index>(2 * m);
      EXPECT_LT(std::abs(fit.rates[m].imag() - truth.imag()), 4.0 * std::sqrt(fit.covariance(at, at)));
      EXPECT_LT(std::abs(fit.rates[m].real() - truth.real()),
                4.0 * std::sqrt(fit.covariance(at + 1, at + 1)));
    }
  }
}

TEST(JointDecayFit, RefusesWhatItCannotFit) {
  const MatrixXd outputs = noisy_decay(0, 1);
  EXPECT_THROW(fit_decays_jointly(outputs, 0.01, {}), std::invalid_argument);
  EXPECT_THROW(fit_decays_jointly(outputs.leftCols(9), 0.01, {complex_rate(5, 0.01)}), std::invalid_argument);
  EXPECT_THROW(fit_decays_jointly(outputs, 0.01, {Complex(-1, 0)}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::stabilisation_test
