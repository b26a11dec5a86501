// Truth and bound of a sweep belong to the beam and the sensors simulated. Oracles: modal masses and
// frequencies of both beams; a bound is proportional to the noise; Wilson's interval by hand.
#include <gmock/gmock.h>

#include <cmath>

#include "experiments/config/read_experiment.hpp"
#include "experiments/studies/sweep/report.hpp"
#include "experiments/sweep/manifest.hpp"
#include "experiments/sweep/rows.hpp"
#include "experiments/sweep/statistics.hpp"
#include "experiments/sweep/sweep_plan.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "tests/experiments/sweep/exact_rig.hpp"
#include "tests/experiments/sweep/sweep_rows.hpp"

namespace beamid::experiments::true_beam_test {
namespace {

SweepPlan plan_of(const std::vector<std::string>& vary, int seeds, bool at_once) {
  const SweepPlan plan = plan_with(vary, 1, seeds);
  return at_once ? once(plan) : plan;
}

std::vector<SweepRow> swept(const SweepPlan& plan) {
  return perform({{"rig.toml", test::exact_rig}, {}, {}}, plan, {}, [](const std::string&) {});
}

struct Mode {
  double mass, omega;  // at the tip [kg], [rad/s]
};

Mode first_mode(double tip_mass) {
  const Experiment experiment = read_experiment(
      TomlTable::parse(test::exact_rig, "rig.toml", {{"beam", "tip_mass_kg", tip_mass, "the test"}}));
  const fem::StructuralSystem system = fem::assemble(experiment.structure, experiment.elements);
  const fem::Modes modes = fem::modes(system, 1);
  const double tip = (system.outputs * modes.shape.col(0))[0];
  return {1.0 / (tip * tip), modes.angular_frequency[0]};
}

TEST(SweepTruth, IsThatOfTheBeamSimulatedWhateverMassIsAssumed) {
  const Mode lighter = first_mode(0.30), assumed = first_mode(0.36);
  const double truth = lighter.mass * lighter.omega * lighter.omega;
  const double bias = 100.0 * (assumed.mass / lighter.mass - 1.0);  // of M omega^2 with the wrong M: 5.8 %
  ASSERT_GT(bias, 5.0);
  for (const bool once : {true, false}) {
    const SweepPlan plan = plan_of({"truth.beam.tip_mass_kg=0.30"}, 8, once);
    const auto rows = swept(plan);
    for (const PointStatistics& one : statistics(plan, rows)) {
      EXPECT_NEAR(one.bias_percent, bias, 5.0 * one.bias_percent_error + 0.05) << one.parameter << once;
      if (one.parameter == "stiffness") {
        EXPECT_EQ(one.coverage.count, 0) << once;
        EXPECT_NEAR(rows[0].truth / truth, 1.0, 1e-9) << once;
      }
    }
  }
}

TEST(SweepBound, FollowsTheNoiseSimulatedAndNotTheOneAssumed) {
  for (const bool once : {true, false}) {
    const SweepPlan plan = plan_of({"sensors[1].noise_m=1e-4,1e-3"}, 1, once);
    const auto rows = swept(plan);
    ASSERT_EQ(rows.size(), 4u);
    EXPECT_NEAR(rows[2].bound / rows[0].bound, 10.0, once ? 1e-6 : 1.0) << once;
  }
}

TEST(SweepReport, PrintsNoErrorBelowTheBoundWithoutASentence) {
  const auto text_of = [](double error) {
    const SweepPlan plan = plan_with({"beam.length_m=1,2"}, 1, 50);
    std::vector<SweepRow> rows;
    for (std::size_t i = 0; i < 50; ++i) {
      SweepRow row;
      row.number = i;
      row.values = {"1"};
      row.filter = "ekf";
      row.status = "converged";
      row.parameter = "stiffness";
      row.truth = 10.0;
      row.error = i % 2 == 0 ? error : -error;
      row.estimate = row.truth + row.error;
      row.deviation = row.bound = 1.0;
      row.lower = row.estimate - 2.0;
      row.upper = row.estimate + 2.0;
      rows.push_back(row);
    }
    std::string text;
    for (const auto& part :
         report(manifest_of({{"rig.toml", test::exact_rig}, {}, {}}, plan, {}), plan, rows).report)
      if (const auto* paragraph = std::get_if<Paragraph>(&part)) text += paragraph->text + "\n";
    return text;
  };
  // Of 50 runs the ratio scatters by 1 / sqrt(100): three times that is chance.
  EXPECT_THAT(text_of(0.3), testing::HasSubstr("below the Cramer-Rao bound, rms / bound: stiffness 0.3"));
  EXPECT_THAT(text_of(0.9), testing::HasSubstr("values down to 0.700 are chance"));
  EXPECT_THAT(text_of(0.9), testing::Not(testing::HasSubstr("below the Cramer-Rao bound")));
  EXPECT_THAT(text_of(1.1), testing::Not(testing::HasSubstr("rms / bound")));
}

}  // namespace
}  // namespace beamid::experiments::true_beam_test
