// Oracle: the Cramer-Rao bound, which the rms error of an efficient estimator equals.
#include "experiments/studies/efficiency/report.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

namespace beamid::experiments::efficiency_test {
namespace {

Choice filter(const char* name) {
  return {name, filters::filter_registry().completed(name, {}), {}};
}

EfficiencySettings small() {
  EfficiencySettings settings;
  settings.filters = {filter("ekf")};
  settings.damping_ratios = {0.1};
  settings.passes = {Passes::lengthening};
  settings.runs = 400;
  return settings;
}

const Progress quiet = [](const std::string&) {};

TEST(LengtheningPasses, ReachTheBoundFromHalfAndTwiceTheTruth) {
  // Within 3.3 standard errors of the rms, 5 % allowed beside them; none of 400 runs lost.
  EfficiencySettings settings = small();
  settings.filters = {filter("ekf"), filter("ukf")};
  settings.decay.guess = Guess::ends;
  for (const EfficiencyCase& one : find_efficiency(settings, quiet).cases) {
    EXPECT_EQ(one.result.diverged.count, 0) << one.filter.name;
    EXPECT_TRUE(one.result.consistent()) << one.filter.name << ' ' << one.result.nees;
    for (const Eigen::Index i : {0, 1})
      EXPECT_NEAR(one.result.rms_over_bound[i], 1.0, 0.05 + 3.3 * one.result.relative_rms_deviation)
          << one.filter.name << ' ' << i;
  }
}

TEST(LengtheningPasses, GiveTheSameAnswerWhateverTheGuess) {
  // Oracle: the record is the same; converged passes forget the guess to a tenth of a deviation.
  DecaySettings decay;
  decay.guess = Guess::ends;
  const FreeDecays decays(decay);
  const filters::Trial low = decays.trial(3);  // both guesses half
  filters::Trial high = low;
  high.initial.mean.tail<2>() *= 4.0;
  high.initial.covariance.diagonal().tail<2>() *= 16.0;
  const auto ekf = filters::filter_registry().make("ekf", {}, decays.model());
  LengtheningSettings settings;
  settings.first_samples = 25;
  const auto from_low = lengthening_passes(*ekf, low.initial, low.record, {2, 3}, settings),
             from_high = lengthening_passes(*ekf, high.initial, high.record, {2, 3}, settings);
  ASSERT_TRUE(from_low && from_high);
  for (const Eigen::Index i : {0, 1}) {
    EXPECT_NEAR(from_low->mean[2 + i], from_high->mean[2 + i], 0.1 * decays.bound()[i]);
    EXPECT_NEAR(from_low->deviations()[2 + i], decays.bound()[i], 0.1 * decays.bound()[i]);
  }
}

TEST(LengtheningPasses, RefuseNumbersOutOfRange) {
  const FreeDecays decays({});
  const filters::Trial trial = decays.trial(1);
  const auto ekf = filters::filter_registry().make("ekf", {}, decays.model());
  const auto with = [&](const LengtheningSettings& settings) {
    return lengthening_passes(*ekf, trial.initial, trial.record, {2, 3}, settings);
  };
  EXPECT_THROW(with({.first_samples = 0}), std::invalid_argument);
  EXPECT_THROW(with({.passes = 0}), std::invalid_argument);
  EXPECT_THROW(with({.last_passes = 0}), std::invalid_argument);
  EXPECT_THROW(with({.widening = 1.0}), std::invalid_argument);
}

TEST(FreeDecays, BoundFallsAsTheNoise) {
  // Oracle: the information is quadratic in 1 / noise.
  DecaySettings quiet_sensor, loud_sensor;
  loud_sensor.noise = 3.0 * quiet_sensor.noise;
  const Eigen::Vector2d ratio =
      FreeDecays(loud_sensor).bound().cwiseQuotient(FreeDecays(quiet_sensor).bound());
  EXPECT_NEAR(ratio[0], 3.0, 1e-9);
  EXPECT_NEAR(ratio[1], 3.0, 1e-9);
  EXPECT_THROW(FreeDecays({.damping_ratio = 1.0}), std::invalid_argument);
  EXPECT_THROW(FreeDecays({.noise = 0.0}), std::invalid_argument);
  EXPECT_THROW(FreeDecays({.cycles = 0.1}), std::invalid_argument);
}

TEST(Efficiency, DoesNotDependOnTheNumberOfThreads) {
  // Oracle: the same trials one after the other, bit for bit.
  EfficiencySettings settings = small();
  settings.runs = 20;
  const auto with_threads = [&](std::size_t count) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, count);
    return find_efficiency(settings, quiet).cases.front().result;
  };
  const auto alone = with_threads(1), together = with_threads(4);
  EXPECT_EQ(alone.rms, together.rms);
  EXPECT_EQ(alone.bias, together.bias);
  EXPECT_EQ(alone.nees, together.nees);
}

TEST(Efficiency, RefusesWhatItCannotExamine) {
  EfficiencySettings settings = small();
  settings.filters = {filter("kf")};
  EXPECT_THROW(find_efficiency(settings, quiet), std::invalid_argument);
  settings = small();
  settings.runs = 1;
  EXPECT_THROW(find_efficiency(settings, quiet), std::invalid_argument);
  settings = small();
  settings.damping_ratios.clear();
  EXPECT_THROW(find_efficiency(settings, quiet), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::efficiency_test
