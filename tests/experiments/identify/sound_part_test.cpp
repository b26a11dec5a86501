// Decays that something befell. Oracle: the truth the record was simulated with, and when it was knocked.
#include "experiments/identify/engine/identification_request.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/experiments/identify/simulated_record.hpp"

namespace beamid::experiments::sound_part_test {
namespace {

using Eigen::Index;

const test::SimulatedBeam simulated;

double amplitude_of(const Record& record) {
  return record.samples.cwiseAbs().maxCoeff();
}

/// A sensor whose range ends at a share of the amplitude, with noise (relative) of the structure before it.
Record clipped(double share, double relative_noise, std::uint64_t seed) {
  const double limit = share * amplitude_of(simulated.record({Quantity::acceleration}, 0, seed));
  Record record = simulated.record({Quantity::acceleration}, relative_noise, seed);
  record.samples = record.samples.cwiseMin(limit).cwiseMax(-limit);
  return record;
}

/// The motion from an instant [s] on times 1 + more.
Record knocked(double at, double more, std::uint64_t seed) {
  const Record pure = simulated.record({Quantity::acceleration}, 0, seed);
  Record record = simulated.record({Quantity::acceleration}, 0.01, seed);
  for (Index k = 0; k < record.size(); ++k)
    if (record.time[k] >= at) record.samples(0, k) += more * pure.samples(0, k);
  return record;
}

/// Taken at half the rate from an instant [s] on, under stamps that go on as before.
Record slowed(double from, std::uint64_t seed) {
  Record record = simulated.record({Quantity::acceleration}, 0.01, seed);
  Index k = 0;
  while (k < record.size() && record.time[k] < from) ++k;
  for (Index taken = k; taken < record.size(); ++k, taken += 2)
    record.samples(0, k) = record.samples(0, taken);
  record.time.conservativeResize(k);
  record.samples.conservativeResize(Eigen::NoChange, k);
  return record;
}

bool holds(double estimate, double half_width, double truth) {
  return std::abs(estimate - truth) <= half_width;
}

// Of 30 intervals of 95 %, fewer than 25 hold by chance once in 160 times.
TEST(SoundPart, OfADecayThatClipsKeepsTheDampingRatioRight) {
  int held = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Record record = clipped(0.75, 0.06, seed);
    const std::vector<RecordDefect> defects = mark_defects(record, "clipped.csv");
    const auto part = sound_part(simulated.experiment(), record, defects);
    ASSERT_TRUE(part);
    EXPECT_THAT(part->words, testing::StartsWith("Readings are clipped: "));
    EXPECT_GT(part->from, 1);
    const RecordIdentification r =
        identify_record(simulated.experiment(), record.window(part->from, part->to));
    const Identification& i = r.identification;
    held += holds(i.found.damping_ratio(), 1.96 * r.damping_factor() * i.damping_ratio_deviation,
                  simulated.damping_ratio);
  }
  EXPECT_GE(held, 25);
}

TEST(SoundPart, OfAKnockedDecayIsTheSideThatTellsMore) {
  for (const double at : {3.0, 7.0}) {
    const auto part = sound_part(simulated.experiment(), knocked(at, 0.2, 3), {});
    ASSERT_TRUE(part) << at;
    EXPECT_NEAR(at < 5 ? part->from : part->to, at, 0.6) << at;
    EXPECT_THAT(part->words, testing::HasSubstr("the motion jumps, by +2")) << at;
  }
}

// Behind the change the frequency reads twice what it is: that part is not the mode as described.
TEST(SoundPart, IsThatAtTheRateOfTheStamps) {
  for (const double from : {3.0, 5.0}) {
    const auto part = sound_part(simulated.experiment(), slowed(from, 8), {});
    ASSERT_TRUE(part) << from;
    EXPECT_LT(part->from, 0.1) << from;
    EXPECT_NEAR(part->to, from, 0.6) << from;
    EXPECT_THAT(part->words, testing::HasSubstr("the frequency jumps from ")) << from;
  }
}

TEST(DecayObjections, ContradictADecayAcrossAChangeOfRate) {
  const RecordIdentification r = identify_record(simulated.experiment(), slowed(5.0, 9));
  EXPECT_EQ(r.judgement.verdict, ComparedRun::Status::contradicted);
  ASSERT_FALSE(r.judgement.objections.empty());
  EXPECT_THAT(r.judgement.objections[0].text,
              testing::ContainsRegex("the frequency jumps from 3.4.* times, while the motion"));
}

TEST(SoundPart, OfASoundDecayIsNotAsked) {
  EXPECT_FALSE(sound_part(simulated.experiment(), simulated.record({Quantity::acceleration}, 0.01, 4), {}));
}

// Where somebody says that all of it is to be identified, it is, and contradicted.
TEST(DecayObjections, ContradictADecayAcrossAKnock) {
  const RecordIdentification r = identify_record(simulated.experiment(), knocked(5.0, 0.2, 5));
  EXPECT_EQ(r.judgement.verdict, ComparedRun::Status::contradicted);
  ASSERT_FALSE(r.judgement.objections.empty());
  EXPECT_THAT(
      r.judgement.objections[0].text,
      testing::AllOf(testing::HasSubstr("s the motion jumps, by +20 %"), testing::HasSubstr("--window")));
}

// Behind a sway the sections of the decay tell nothing of the amplitude: the overtone does.
TEST(DecayObjections, ContradictASensorThatSaturates) {
  Record record = simulated.record({Quantity::acceleration}, 0.01, 6);
  const double amplitude = amplitude_of(record);
  for (Index k = 0; k < record.size(); ++k) {
    const double x = record.samples(0, k) + 0.16 * amplitude * std::sin(2.5 * record.time[k]);
    record.samples(0, k) = 0.8 * amplitude * std::tanh(x / (0.8 * amplitude));
  }
  const RecordIdentification r = identify_record(simulated.experiment(), record);
  EXPECT_LT(r.identification.found.damping_ratio(), 0.9 * simulated.damping_ratio);
  EXPECT_EQ(r.judgement.verdict, ComparedRun::Status::contradicted);
  ASSERT_FALSE(r.judgement.objections.empty());
  EXPECT_THAT(r.judgement.objections[0].text, testing::HasSubstr("An overtone at three times the frequency"));
}

}  // namespace
}  // namespace beamid::experiments::sound_part_test
