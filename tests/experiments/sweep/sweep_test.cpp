// Whole sweeps. Oracles: a filter whose model is exact; the beam simulated.
#include <gmock/gmock.h>

#include <cmath>
#include <numeric>

#include "experiments/studies/sweep/report.hpp"
#include "experiments/sweep/statistics.hpp"
#include "experiments/text/input_error.hpp"
#include "tests/experiments/sweep/exact_rig.hpp"
#include "tests/experiments/sweep/sweep_rows.hpp"

namespace beamid::experiments::sweep_test {
namespace {

using testing::HasSubstr, testing::ThrowsMessage;

TEST(RunCases, EndsAllThreadsWithTheFirstTrouble) {
  std::vector<std::size_t> all(1000);
  std::iota(all.begin(), all.end(), std::size_t{0});
  CaseQueue queue(blocks_of({}, all));
  int kept = 0;
  EXPECT_THROW(
      run_cases(
          queue, 3, [](const CaseBlock& block) { return std::vector<SweepRow>{found_row(block[0], 1)}; },
          [&](std::vector<SweepRow> rows) {
            if (rows[0].number == 20) throw std::runtime_error("full");
            ++kept;
          }),
      std::runtime_error);
  EXPECT_LT(kept, 1000);
}

// Oracle: the filter's own promise. 200 runs of 95 % lie between 90.5 % and 99 % in 99 % of such tests.
TEST(Sweep, FindsTheExactFilterConsistentAndEfficient) {
  const SweepPlan plan = plan_with({}, 1, 200);
  SweepSettings settings;
  settings.threads = 2;
  const auto rows =
      perform({{"rig.toml", test::exact_rig}, {}, {}}, plan, settings, [](const std::string&) {});
  const auto all = statistics(plan, rows);
  ASSERT_EQ(all.size(), 2u);
  for (const PointStatistics& one : all) {
    EXPECT_EQ(one.converged, 200) << one.parameter;
    EXPECT_GE(one.coverage.value(), 0.905) << one.parameter;
    EXPECT_LE(one.coverage.value(), 0.99) << one.parameter;
    EXPECT_LT(std::abs(one.bias_percent), 3.5 * one.bias_percent_error) << one.parameter;
    EXPECT_NEAR(one.rms_over_bound, 1.0, 3.5 / std::sqrt(2.0 * 200)) << one.parameter;
  }
}

// Oracle: the beam simulated.
TEST(Sweep, SimulatesWhatSensorsAndLoggerDo) {
  const std::string coarse = std::string(test::exact_rig) + "[acquisition]\njitter = 0.2\nrepeated = 0.02\n";
  const SweepPlan plan = plan_with({}, 1, 1);
  const auto perfect = run_case({{"rig.toml", test::exact_rig}, {}, {}}, plan, 0),
             logged = run_case({{"rig.toml", coarse}, {}, {}}, plan, 0);
  ASSERT_EQ(logged.size(), perfect.size());
  for (std::size_t i = 0; i < logged.size(); ++i) {
    EXPECT_EQ(logged[i].status, "converged") << logged[i].reason;
    EXPECT_NE(logged[i].estimate, perfect[i].estimate);
    EXPECT_LT(std::abs(logged[i].error), 5.0 * logged[i].deviation) << logged[i].parameter;
  }
}

TEST(Sweep, ReachesTablesWithinTablesAndTheTruthAlone) {
  const SweepPlan plan =
      plan_with({"sensors[1].noise_m=0.001,0.002", "truth.beam.tip_mass_kg=0.4", "beam.elements=12"});
  const SweepSource source{{"rig.toml", test::exact_rig}, {}, {}};
  const Experiment assumed = experiment_of(source, plan, 1), truth = experiment_of(source, plan, 1, true);
  EXPECT_EQ(assumed.sensors[0].noise, 0.002);
  EXPECT_EQ(assumed.elements, 12);
  EXPECT_EQ(assumed.structure.beam().tip_mass(), 0.36);
  EXPECT_EQ(truth.structure.beam().tip_mass(), 0.4);
  EXPECT_EQ(truth.simulation.seed, 2u);
  EXPECT_THAT([&] { experiment_of(source, plan_with({"sensors[2].noise_m=1"}), 0); },
              ThrowsMessage<InputError>(HasSubstr("there is no sensors[2]; sensors has 1 tables")));
}

}  // namespace
}  // namespace beamid::experiments::sweep_test
