// Records of one plan identified together. Oracles: every case by itself; the filter's own promise.
#include <gmock/gmock.h>

#include <cmath>
#include <numeric>

#include "experiments/studies/sweep/report.hpp"
#include "experiments/sweep/repeats.hpp"
#include "experiments/sweep/statistics.hpp"
#include "tests/experiments/sweep/exact_rig.hpp"
#include "tests/experiments/sweep/sweep_rows.hpp"

namespace beamid::experiments::repeats_test {
namespace {

using testing::ElementsAre, testing::HasSubstr;

std::string lines_of(const std::vector<SweepRow>& rows) {
  std::string lines;
  for (const SweepRow& row : rows) lines += to_line(row);
  return lines;
}

// Blocks end with a sample, and where cases are missing that an earlier process has finished.
TEST(Blocks, HoldNeighboursOfOneSampleWhereThePlanIdentifiesOnce) {
  const SweepPlan plan = plan_with({"beam.length_m=1,2"}, 1, 20);
  std::vector<std::size_t> left(40);
  std::iota(left.begin(), left.end(), std::size_t{0});
  EXPECT_EQ(blocks_of(plan, left).size(), 40u);
  std::vector<std::size_t> sizes;
  for (const CaseBlock& block : blocks_of(once(plan), left)) sizes.push_back(block.size());
  EXPECT_THAT(sizes, ElementsAre(16u, 4u, 16u, 4u));
  EXPECT_EQ(CaseQueue(blocks_of(once(plan), {3, 7, 19, 20, 39})).cases(), 5u);
}

// Oracle: every case by itself.
TEST(Repeats, AreTheSameBytesInWhateverBlock) {
  const SweepSource source{{"rig.toml", test::exact_rig}, {}, {}};
  const SweepPlan plan = once(plan_with({"sensors[1].noise_m=0.0003,0.01"}, 1, 7));
  Repeats together(source, plan), apart(source, plan);
  for (const CaseBlock& block : {CaseBlock{0, 1, 2, 3, 4, 5, 6}, CaseBlock{7, 8, 10, 13}}) {
    std::string alone;
    for (const std::size_t number : block) alone += lines_of(apart.run({number}));
    EXPECT_EQ(lines_of(together.run(block)), alone);
  }
}

// Oracle: the registered filter, one record after another; on_failure = "report" keeps it out of the lanes.
TEST(Repeats, GiveWhatTheFilterGivesEachRecord) {
  const SweepPlan plan = once(plan_with({}, 1, 6));
  const CaseBlock block{0, 1, 2, 3, 4, 5};
  for (const std::string scheme : {"exponential", "forward_euler"}) {
    const std::string chosen = test::exact_rig + ("[filter]\ndiscretisation = \"" + scheme + "\"\n");
    const SweepSource source{{"rig.toml", chosen}, {}, {}},
        registered{{"rig.toml", chosen + "on_failure = \"report\"\n"}, {}, {}};
    const auto lanes = Repeats(source, plan).run(block), alone = Repeats(registered, plan).run(block);
    ASSERT_EQ(lanes.size(), 12u) << lanes[0].reason;
    ASSERT_EQ(alone.size(), 12u) << alone[0].reason;
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      EXPECT_EQ(lanes[i].discretisation, scheme);
      EXPECT_EQ(lanes[i].status, alone[i].status) << lanes[i].reason << alone[i].reason;
      EXPECT_EQ(lanes[i].bound, alone[i].bound);
      EXPECT_NEAR(lanes[i].estimate, alone[i].estimate, 1e-8 * alone[i].deviation);
      EXPECT_NEAR(lanes[i].deviation, alone[i].deviation, 1e-8 * alone[i].deviation);
    }
  }
}

// Oracle: the Cramer-Rao bound, and the filter's own promise; bands as above. A stiffness known to 5 % is
// near enough for a single pass.
TEST(Repeats, AreAsNearToTheTruthAsTheBoundSays) {
  const std::string doubt = "[[parameters]]\nquantity = \"stiffness\"\nrelative_deviation = 0.05\n";
  const SweepSource source{{"rig.toml", test::exact_rig + doubt}, {}, {}};
  const auto rows = perform(source, once(plan_with({}, 1, 200)), {}, [](const std::string&) {});
  for (const PointStatistics& one : statistics(plan_with({}, 1, 200), rows)) {
    EXPECT_EQ(one.converged, 200) << one.parameter;
    EXPECT_NEAR(one.rms_over_bound, 1.0, 3.5 / std::sqrt(2.0 * 200)) << one.parameter;
    EXPECT_GE(one.coverage.value(), 0.905) << one.parameter;
  }
}

// Oracle: the finding. Explicit Euler steps turn C into C + K dt, to first order in the damping; K is kept.
TEST(Repeats, ByForwardEulerMissTheDampingAsTheClosedFormSays) {
  std::string rig = test::exact_rig;
  const std::string slow = "duration_s = 4\nsampling_rate_hz = 40\n";
  rig.replace(rig.find(slow), slow.size(), "duration_s = 10\nsampling_rate_hz = 1000\nmodes = 1\n");
  rig += "[filter]\ndiscretisation = \"forward_euler\"\n";
  const SweepPlan plan = once(plan_with({}, 1, 8));
  const auto rows = perform({{"rig.toml", rig}, {}, {}}, plan, {}, [](const std::string&) {});
  const auto all = statistics(plan, rows);
  ASSERT_EQ(all.size(), 2u);
  const double stiffness = rows[0].truth;
  EXPECT_NEAR(all[0].bias_percent, 0.0, 0.1);
  EXPECT_NEAR(all[1].bias, 1e-3 * stiffness, 0.01 * 1e-3 * stiffness);
}

TEST(Repeats, SayWhatTheyCannotTake) {
  const std::string modal = std::string(test::exact_rig) + "[model]\nname = \"modal\"\n";
  const auto rows = Repeats({{"rig.toml", modal}, {}, {}}, once(plan_with({}))).run({0});
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].status, "failed");
  EXPECT_THAT(rows[0].reason, HasSubstr("takes model sdof and one reduction; found model modal"));
}

TEST(Repeats, RefuseReadingsThatALoggerHasChanged) {
  const std::string jittered = std::string(test::exact_rig) + "[acquisition]\njitter = 0.1\n";
  const auto rows = Repeats({{"rig.toml", jittered}, {}, {}}, once(plan_with({}))).run({0});
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].status, "failed");
  EXPECT_THAT(rows[0].reason, HasSubstr("takes records of perfect instruments"));
}

}  // namespace
}  // namespace beamid::experiments::repeats_test
