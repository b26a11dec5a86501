// Laboratory records: the tests that are drawn, their truth, and how outcomes are judged.
#include "experiments/studies/efficiency/laboratory_records.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "fem/exact/exact_cantilever.hpp"

namespace beamid::experiments::laboratory_records_test {
namespace {

using testing::HasSubstr, testing::Not;

TEST(LaboratoryTest, IsDrawnFromItsSeedAndNumber) {
  EXPECT_EQ(laboratory_test(1, 5).rig, laboratory_test(1, 5).rig);
  EXPECT_NE(laboratory_test(1, 5).rig, laboratory_test(2, 5).rig);
  EXPECT_NE(laboratory_test(1, 5).rig, laboratory_test(1, 17).rig);
}

TEST(LaboratoryTest, CoversEveryKindAndTheAskedRanges) {
  std::set<LaboratoryKind> seen;
  for (int number = 0; number < 100; ++number) {
    const LaboratoryTest test = laboratory_test(1, number);
    seen.insert(test.kinds.begin(), test.kinds.end());
    const TomlTable table = TomlTable::parse(test.rig, "rig.toml");
    const Experiment rig = read_experiment(table);
    EXPECT_GE(rig.simulation.sampling_rate, 50.0);
    EXPECT_LE(rig.simulation.sampling_rate, 2000.0);
    EXPECT_GE(rig.simulation.sampling_rate, 11.99 * test.frequency_hz) << number;
    EXPECT_GE(rig.simulation.duration * test.frequency_hz, 9.0) << number;
    const bool uneven = read_acquisition(table).jitter > 0;
    EXPECT_EQ(uneven, std::count(test.kinds.begin(), test.kinds.end(), LaboratoryKind::jitter) > 0);
  }
  EXPECT_EQ(seen.size(), static_cast<std::size_t>(laboratory_kinds));
}

TEST(LaboratoryTest, TellsTheIdentificationNothingButTheBeam) {
  for (int number = 0; number < laboratory_kinds; ++number) {
    const std::string told = laboratory_test(1, number).beam;
    for (const char* other : {"[record]", "[prior]", "[noise]", "[damping]", "[simulation]", "[acquisition]"})
      EXPECT_THAT(told, Not(HasSubstr(other)));
  }
}

// Oracle: the exact frequency equation of a cantilever with a tip mass, from the numbers of the file.
TEST(LaboratoryTest, KnowsItsFrequency) {
  const LaboratoryTest test = laboratory_test(1, 0);
  const Experiment rig = read_experiment(TomlTable::parse(test.rig, "rig.toml"));
  const fem::Beam& beam = rig.structure.beam();
  const fem::Cantilever exact{beam.length(), beam.segments[0].section.bending_stiffness.mean(),
                              beam.mass() / beam.length(), beam.tip_mass()};
  EXPECT_NEAR(fem::ExactMode(exact, 1).angular_frequency() / (2 * std::numbers::pi) / test.frequency_hz, 1.0,
              1e-6);
}

// Oracle: A' = -w (xi + k A) A, solved: A / (xi + k A) falls as e^(-w xi t).
TEST(LaboratoryTest, KnowsADampingThatFallsWithAmplitude) {
  const LaboratoryTest test = laboratory_test(1, static_cast<int>(LaboratoryKind::amplitude));
  ASSERT_EQ(test.kinds[0], LaboratoryKind::amplitude);
  const LaboratoryRecord record = simulate(test);
  const double xi = test.least_damping, period = 1 / test.frequency_hz, from = record.event + 3 * period,
               to = record.time[record.time.size() - 1];
  const auto [least, greatest] = damping_between(test, record, from, to);
  EXPECT_GT(greatest, least);
  const auto ratio = [&](double damping) { return (damping - xi) / damping; };  // k A / (xi + k A)
  const double passed =
      std::log(ratio(greatest) / ratio(least)) / (2 * std::numbers::pi * test.frequency_hz * xi);
  EXPECT_NEAR(passed, to - from - period, 0.6 * period + 0.02 * (to - from));
}

TEST(LaboratoryOutcome, JudgesByTheTruthAndTheInterval) {
  EXPECT_TRUE(right_frequency({10.04, 0.001}, 10.0));
  EXPECT_FALSE(right_frequency({10.06, 0.001}, 10.0));
  EXPECT_TRUE(right_frequency({10.06, 0.05}, 10.0));
  EXPECT_FALSE(right_frequency({12.0, 5.0}, 10.0));
  EXPECT_TRUE(right_damping({0.0057, 1e-5}, 0.005, 0.005));
  EXPECT_FALSE(right_damping({0.0060, 1e-5}, 0.005, 0.005));
  EXPECT_TRUE(right_damping({0.0060, 0.001}, 0.005, 0.005));
  EXPECT_TRUE(right_damping({0.0060, 1e-5}, 0.003, 0.007));
  EXPECT_FALSE(right_damping({0.0200, 0.03}, 0.005, 0.005));
}

TEST(LaboratoryRecords, RefuseNone) {
  EXPECT_THROW(laboratory_records({0, 1}, [](const std::string&) {}), std::invalid_argument);
  EXPECT_THROW(examine({12, 1}, 12), std::invalid_argument);
}

// Every kind twice. Oracle: the beams that were simulated.
TEST(LaboratoryRecords, AreRightOrRefusedForTheirCause) {
  const LaboratoryRecords all = laboratory_records({2 * laboratory_kinds, 1}, [](const std::string&) {});
  for (const IdentifiedTest& one : all.tests) {
    const bool dead = one.test.kinds.front() == LaboratoryKind::dead;
    EXPECT_EQ(one.outcome,
              dead || one.test.number == 9 ? LaboratoryOutcome::refused : LaboratoryOutcome::right)
        << one.test.number << ": " << one.said;
  }
}

}  // namespace
}  // namespace beamid::experiments::laboratory_records_test
