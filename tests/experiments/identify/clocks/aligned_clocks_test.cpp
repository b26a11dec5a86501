// Channels of other clocks. Oracles: a record of ten times the rate, of which other samples are taken, so
// that nothing is interpolated; parameters that it was simulated with; chi-square bands of errors over
// deviations.
#include "experiments/identify/clocks/aligned_clocks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/config/read_experiment.hpp"
#include "experiments/rig/simulated_test.hpp"
#include "experiments/signal/toolbox.hpp"
#include "tests/experiments/identify/ground_motion.hpp"
#include "tests/experiments/results/temporary_folder.hpp"

namespace beamid::experiments::aligned_clocks_test {
namespace {

using Eigen::Index;

constexpr const char* building = R"toml(
[chain]
masses_kg = [1000, 800]
stiffnesses_n_per_m = [0.5e6, 0.4e6]
heights_m = [3, 3]
[damping]
law = "modal"
ratio = 0.02
[excitation]
kind = "base"
file = "quake.csv"
[simulation]
duration_s = 9
sampling_rate_hz = 1000
steps_per_sample = 1
[[sensors]]
quantity = "acceleration"
position_m = 3
noise_m_per_s2 = 0.01
[[sensors]]
quantity = "acceleration"
position_m = 6
noise_m_per_s2 = 0.01
[model]
name = "beam"
[reduction]
method = "none"
[[parameters]]
quantity = "storey_stiffness"
from_m = 0
to_m = 3
guess_n_per_m = 0.6e6
[[parameters]]
quantity = "storey_stiffness"
from_m = 3
to_m = 6
guess_n_per_m = 0.35e6
[[parameters]]
quantity = "damping_ratio"
)toml";

class Clocks : public testing::Test {
 protected:
  Clocks() { test::write_ground_motion(place_.path / "quake.csv", 1401); }

  /// Every tenth sample of two floors and the base, each channel by so many thousandths of a second late, and
  /// by a share of the time more: between samples of 1 ms straight, 2e-4 of the motion.
  Comparison found(std::uint64_t seed, const std::vector<Index>& late_ms, std::vector<std::string> own,
                   const std::vector<double>& growth = {0.0, 0.0, 0.0}) const {
    Experiment e = read_experiment(TomlTable::parse(building, "building.toml"));
    e.simulation.seed = seed;
    const Record fine = simulate(e, place_.path, 0, unwatched).record;
    const Index first = 500, count = 800;
    Record record = fine;
    record.time = 0.01 * Eigen::VectorXd::LinSpaced(count, 0.0, static_cast<double>(count - 1));
    record.samples.resize(3, count);
    for (Index i = 0; i < 3; ++i)
      for (Index k = 0; k < count; ++k) {
        const auto channel = static_cast<std::size_t>(i);
        const double lag = growth[channel] * 10.0 * static_cast<double>(k);
        const Index at = first + 10 * k - late_ms[channel] - static_cast<Index>(std::floor(lag));
        const double share = lag - std::floor(lag);
        record.samples(i, k) = (1.0 - share) * fine.samples(i, at) + share * fine.samples(i, at - 1);
      }
    record.own_clock = std::move(own);
    return identify_with_model(e, measured_record("late", record), place_.path, unwatched);
  }

  TemporaryFolder place_;
};

// 10 lags and 30 parameters; bands of 99.8 %. Over 60 seeds of 12.5 s: chi-square of the lags 47, their rms
// error 0.0116 ms beside 0.0128.
TEST_F(Clocks, OfSensorsAreFoundAsSurelyAsIsSaid) {
  const std::vector<double> truth{0.5e6, 0.4e6, 0.02};
  double of_lags = 0.0, of_parameters = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto late = static_cast<Index>(49 * seed - 240);
    const Comparison comparison = found(seed, {0, late, 0}, {"tip"});
    const ComparedRun& run = comparison.runs.at(0);
    ASSERT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
    const OwnClock& clock = comparison.compared.clocks.at(0);
    EXPECT_LT(clock.deviation, 1e-4);
    of_lags += std::pow((clock.lag - 1e-3 * static_cast<double>(late)) / clock.deviation, 2);
    for (std::size_t j = 0; j < truth.size(); ++j) {
      const ComparedParameter& p = run.parameters.at(j);
      of_parameters += std::pow((p.estimate.value - truth[j]) / p.estimate.deviation, 2);
      const double ratio = p.estimate.deviation / *p.bound;  // wider by the noise that is there at the mode
      EXPECT_TRUE(ratio > 0.97 && ratio < 1.3) << p.estimate.name << ' ' << ratio;
    }
  }
  EXPECT_GT(of_lags, 1.48);
  EXPECT_LT(of_lags, 29.6);
  EXPECT_GT(of_parameters, 11.6);
  EXPECT_LT(of_parameters, 59.7);
}

TEST_F(Clocks, OfTheGroundAreFoundAndContradictTheRunThatDoesNotLook) {
  const Comparison unaware = found(7, {0, 0, 413}, {});
  EXPECT_EQ(unaware.runs.at(0).status, ComparedRun::Status::contradicted);
  const Comparison aware = found(7, {0, 0, 413}, {"base_acceleration"});
  ASSERT_EQ(aware.runs.at(0).status, ComparedRun::Status::converged) << aware.runs.at(0).reason;
  const OwnClock& clock = aware.compared.clocks.at(0);
  EXPECT_NEAR(clock.lag, 0.413, 4.0 * clock.deviation);
  EXPECT_LT(clock.deviation, 1e-3);
}

// A lag of less than an interval leaves 1 to 5 % of the record, which no share of it calls wrong.
TEST_F(Clocks, ThatNobodyNamedAreReportedWhereTheyMoveAnAnswer) {
  struct Case {
    std::vector<Index> late_ms;
    const char* who;
    double lag;  // behind the input [s]
    const char* key;
  };
  for (const Case& one :
       {Case{{0, 0, 5}, "All motion is ", -0.005, "own_clock = [\"base_acceleration\"]"},
        Case{{5, 5, 0}, "All motion is ", 0.005, "It is half an interval: look at input in"},
        Case{{0, 4, 0}, "tip is ", 0.004, "own_clock = [\"tip\"]"},
        Case{{3, 0, 0}, "x3m is ", 0.003, "own_clock = [\"x3m\"]"}}) {
    const ComparedRun run = found(11, one.late_ms, {}).runs.at(0);
    EXPECT_EQ(run.status, ComparedRun::Status::contradicted) << one.who;
    EXPECT_THAT(texts(run.objections),
                testing::Contains(testing::AllOf(testing::HasSubstr(one.who), testing::HasSubstr(one.key))));
    EXPECT_NEAR(run.likeliest_clocks.late->lag(), one.lag,
                4.0 * run.interval_factor * run.likeliest_clocks.late->lag_deviation());
  }
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const ComparedRun run = found(seed, {0, 0, 0}, {}).runs.at(0);
    EXPECT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
    EXPECT_THAT(texts(run.objections), testing::Each(testing::Not(testing::HasSubstr("own_clock")))) << seed;
  }
}

// Seconds of one logger are not those of another: 300 ppm are 2.4 ms at the end.
TEST_F(Clocks, AtAnotherRateAreReportedWhereTheyMoveAnAnswer) {
  const std::pair<std::vector<double>, const char*> cases[] = {
      {{0.0, 3e-4, 0.0}, "tip falls behind the rest by "},
      {{-3e-4, 0.0, 0.0}, "x3m runs ahead of the rest by "},
      {{0.0, 0.0, 6e-4}, "All motion runs ahead of base_acceleration by "}};
  for (const auto& [growth, words] : cases) {
    const ComparedRun run = found(11, {0, 0, 0}, {}, growth).runs.at(0);
    EXPECT_EQ(run.status, ComparedRun::Status::contradicted) << words;
    EXPECT_THAT(texts(run.objections), testing::Contains(testing::HasSubstr(words)));
    const LikeliestClock& clock = *run.likeliest_clocks.drifting;
    const double given = growth[0] + growth[1] - growth[2];
    EXPECT_NEAR(clock.growth(), given, 4.0 * run.interval_factor * clock.growth_deviation()) << words;
  }
}

TEST_F(Clocks, AreRefusedWhereNothingTellsThem) {
  const auto refusal = [&](std::vector<std::string> own) -> std::string {
    try {
      found(1, {0, 0, 0}, std::move(own));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(
      refusal({"acceleration"}),
      "own_clock names every channel of motion; expected one at least that keeps the common clock, or the "
      "input's name where that alone has another");
  EXPECT_EQ(refusal({"roof"}),
            "own_clock names no channel 'roof'; the record has: x3m, tip, base_acceleration");
}

TEST(LagByCorrelation, IsThatOfABroadbandSignalWhateverItsResonance) {
  const Eigen::VectorXd white = standard_normal(4200, 5, 0);
  Eigen::MatrixXd read(1, 4000), made(1, 4000);
  double x1 = 0.0, x2 = 0.0, y1 = 0.0, y2 = 0.0;
  for (Index k = 0; k < 4000; ++k) {  // two resonances 5 % apart under the same noise, one 137 samples later
    const double x = 1.95 * x1 - 0.98 * x2 + white[k + 137], y = 1.945 * y1 - 0.98 * y2 + white[k];
    x2 = x1, x1 = x, y2 = y1, y1 = y;
    made(0, k) = x, read(0, k) = y;
  }
  EXPECT_NEAR(lag_by_correlation(read, made, 0.01, 1.0), 1.37, 0.005);
}

}  // namespace
}  // namespace beamid::experiments::aligned_clocks_test
