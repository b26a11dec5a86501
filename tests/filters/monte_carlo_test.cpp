// Seeded runs. Oracles: Gaussian errors made for the purpose, the exact posterior, Wilson's published
// interval.
#include "filters/monte_carlo.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "beamid/testing/oscillator.hpp"
#include "filters/fisher_information.hpp"

namespace beamid::monte_carlo_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::Gaussian, filters::monte_carlo, filters::Trial;

constexpr double dt = 0.02, noise = 2e-4;

std::unique_ptr<filters::DiscreteModel> oscillator() {
  return filters::discretise(std::make_shared<test::Oscillator>(3.0), dt, "exponential",
                             {{}, MatrixXd::Constant(1, 1, noise * noise)});
}

const Eigen::Vector4d motion(0.012, -0.03, 515.8, 1.2);

// A noisy free decay, started with the bound's own prior: the truth is drawn from what the filter assumes.
Trial decay(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const Eigen::Vector4d deviation(2e-4, 2e-3, 5.0, 0.2);
  Trial trial{{VectorXd::LinSpaced(150, 0.0, 149 * dt), MatrixXd(1, 150), {}}, {}, motion.tail(2)};
  const auto model = oscillator();
  VectorXd z = motion, next;
  for (Index k = 0; k < 150; ++k) {
    trial.record.outputs(0, k) = z[0] + noise * normal(random);
    model->transition(z, {}, next);
    z.swap(next);
  }
  trial.initial.mean =
      motion + deviation.cwiseProduct(Eigen::Vector4d::NullaryExpr([&] { return normal(random); }));
  trial.initial.covariance = deviation.cwiseAbs2().asDiagonal();
  return trial;
}

TEST(MonteCarlo, MeasuresGaussianErrorsAsTheyAre) {
  // Oracle: errors of deviation 2 and 3, told as 2 and 1.5: rms ratios, coverage of 1.96/2 deviations.
  const auto generate = [](std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const double first = normal(random);
    return Trial{{}, {Eigen::Vector2d(2.0 * first, 3.0 * normal(random)), {}}, Eigen::Vector2d::Zero()};
  };
  const auto estimate = [](const Trial& trial) -> std::optional<Gaussian> {
    return Gaussian{trial.initial.mean, Eigen::Vector2d(4.0, 2.25).asDiagonal()};
  };
  const auto result = monte_carlo(generate, estimate, {.runs = 4000, .bound = Eigen::Vector2d(2.0, 3.0)});
  for (Index i = 0; i < 2; ++i) {
    EXPECT_NEAR(result.rms_over_bound[i], 1.0, 3.3 * result.relative_rms_deviation);
    EXPECT_LT(std::abs(result.bias[i]), 3.3 * result.bias_deviation[i]);
  }
  EXPECT_NEAR(result.rms_over_deviation[1], 2.0, 3.3 * 2.0 * result.relative_rms_deviation);
  EXPECT_LT(result.coverage[0].lower_95, 0.95);
  EXPECT_GT(result.coverage[0].upper_95, 0.94);
  EXPECT_NEAR(result.coverage[1].value(), std::erf(0.98 / std::sqrt(2.0)), 0.03);
  EXPECT_NEAR(result.nees, 0.5 * (1.0 + 4.0), 0.15);
  EXPECT_FALSE(result.consistent());
  EXPECT_EQ(result.diverged.count, 0);
}

TEST(MonteCarlo, CountsDivergedRunsApart) {
  const auto generate = [](std::uint64_t seed) {
    return Trial{{}, {VectorXd::Constant(1, static_cast<double>(seed)), {}}, VectorXd::Zero(1)};
  };
  const auto estimate = [](const Trial& trial) -> std::optional<Gaussian> {
    if (trial.initial.mean[0] == 3.0) return std::nullopt;
    if (trial.initial.mean[0] == 5.0)
      return Gaussian{VectorXd::Constant(1, std::numeric_limits<double>::quiet_NaN()), MatrixXd::Ones(1, 1)};
    return Gaussian{trial.initial.mean, MatrixXd::Ones(1, 1)};
  };
  const auto result = monte_carlo(generate, estimate,
                                  {.runs = 10, .first_seed = 1, .largest_error = VectorXd::Constant(1, 8.5)});
  EXPECT_EQ(result.diverged.count, 4);
  EXPECT_EQ(result.diverged_seeds, (std::vector<std::uint64_t>{3, 5, 9, 10}));
  EXPECT_NEAR(result.bias[0], (1 + 2 + 4 + 6 + 7 + 8) / 6.0, 1e-14);
}

TEST(MonteCarlo, FindsTheFilterConsistentAndAtTheBound) {
  // Oracle: the posterior Cramer-Rao bound, information of record and prior together.
  const Eigen::Vector4d deviation(2e-4, 2e-3, 5.0, 0.2);
  const auto model = oscillator();
  const MatrixXd information = filters::fisher_information(*model, motion, 150) +
                               MatrixXd(deviation.cwiseAbs2().cwiseInverse().asDiagonal());
  const VectorXd bound = filters::cramer_rao_bound(information).tail(2);
  const auto filter = filters::last_estimate_of(
      [] { return filters::filter_registry().make("ekf", {}, oscillator()); }, {2, 3});
  const auto result = monte_carlo(decay, filter, {.runs = 2000, .bound = bound});
  EXPECT_TRUE(result.consistent()) << result.nees;
  for (Index i = 0; i < 2; ++i) {
    EXPECT_NEAR(result.rms_over_bound[i], 1.0, 0.06) << i;
    EXPECT_NEAR(result.coverage[static_cast<std::size_t>(i)].value(), 0.95, 0.02) << i;
  }
  EXPECT_EQ(result.diverged.count, 0);
}

TEST(Wilson, IntervalIsThePublishedOne) {
  // Oracle: 10 of 100: 0.05523 to 0.17437 (any table of score intervals); none of 2000: 0 to 0.001917.
  const filters::Proportion ten = filters::proportion(10, 100);
  EXPECT_NEAR(ten.lower_95, 0.05523, 1e-5);
  EXPECT_NEAR(ten.upper_95, 0.17437, 1e-5);
  const filters::Proportion none = filters::proportion(0, 2000);
  EXPECT_NEAR(none.lower_95, 0.0, 1e-15);
  EXPECT_NEAR(none.upper_95, 0.001917, 1e-6);
  EXPECT_THROW(filters::proportion(3, 2), std::invalid_argument);
}

TEST(MonteCarlo, RefusesSizesThatDisagree) {
  const auto generate = [](std::uint64_t) { return Trial{{}, {}, VectorXd::Zero(2)}; };
  const auto estimate = [](const Trial&) -> std::optional<Gaussian> {
    return Gaussian{VectorXd::Zero(1), MatrixXd::Ones(1, 1)};
  };
  EXPECT_THROW(monte_carlo(generate, estimate, {.runs = 1}), std::invalid_argument);
  EXPECT_THROW(monte_carlo(generate, estimate, {.runs = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::monte_carlo_test
