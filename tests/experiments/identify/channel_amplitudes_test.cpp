// Channels of one decay beside each other. Oracle: the closed form of the motion, one channel of which is
// multiplied by what a wrong unit multiplies it by.
#include "experiments/identify/engine/analysis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/experiments/identify/simulated_record.hpp"

namespace beamid::experiments::channel_amplitudes_test {
namespace {

using testing::AllOf, testing::Contains, testing::HasSubstr, testing::Not;

const test::SimulatedBeam simulated;

Record acceleration_and_displacement(double factor, std::uint64_t seed) {
  Record record = simulated.record({Quantity::acceleration, Quantity::displacement}, 0.01, seed);
  record.channels[0].name = "acc", record.channels[1].name = "laser";
  record.samples.row(1) *= factor;
  return record;
}

std::string text_of(double factor, std::uint64_t seed = 1) {
  const Experiment e = simulated.experiment();
  return channel_amplitudes(e, analyse(e, acceleration_and_displacement(factor, seed))).text;
}

TEST(ChannelAmplitudes, AreSilentWhereTheyAgree) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) EXPECT_EQ(text_of(1.0, seed), "");
  EXPECT_EQ(text_of(1.2), "");  // a place that is not quite right
}

TEST(ChannelAmplitudes, NameAChannelInAnotherUnit) {
  EXPECT_THAT(text_of(1000.0),
              AllOf(HasSubstr("displacement 'laser' has 1000 times the amplitude"), HasSubstr("mm for m")));
  EXPECT_THAT(text_of(0.001), HasSubstr("m for mm"));
  EXPECT_THAT(text_of(-1.0), HasSubstr("with its sign turned"));
  EXPECT_THAT(text_of(2.0), AllOf(HasSubstr("has 2 times"), Not(HasSubstr("taken for"))));
}

TEST(ChannelAmplitudes, AreAmongTheMessagesOfAnIdentification) {
  const RecordIdentification found =
      identify_record(simulated.experiment(), acceleration_and_displacement(1000.0, 1));
  EXPECT_EQ(found.judgement.verdict, ComparedRun::Status::contradicted);
  EXPECT_THAT(texts(found.judgement.objections),
              Contains(HasSubstr("displacement 'laser' has 1000 times the amplitude")));
}

}  // namespace
}  // namespace beamid::experiments::channel_amplitudes_test
