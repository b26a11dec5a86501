// Whatever asks for an estimate, one engine makes it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/record_identification.hpp"
#include "tests/experiments/identify/simulated_record.hpp"

namespace beamid::experiments::one_engine_test {
namespace {

const test::SimulatedBeam simulated;

Comparison compared(Experiment e, const Record& record) {
  e.reductions = {e.reduction};
  e.filters = {e.filter};
  e.discretisations = {e.discretisation};
  return compare(e, measured_record("record", record), {}, unwatched);
}

// To the last digit: estimate, deviation and verdict.
TEST(OneEngine, IdentifiesAsItCompares) {
  const Record record = simulated.record({Quantity::acceleration}, 0.02, 5);
  const RecordIdentification alone = identify_record(simulated.experiment(), record);
  const ComparedRun run = compared(simulated.experiment(), record).runs.at(0);
  ASSERT_EQ(run.parameters.size(), 2u);
  EXPECT_EQ(run.parameters[0].estimate.value, alone.identification.found.stiffness);
  EXPECT_EQ(run.parameters[1].estimate.value, alone.identification.found.damping);
  EXPECT_DOUBLE_EQ(run.parameters[0].estimate.deviation,
                   alone.frequency_factor() * alone.identification.stiffness_deviation);
  EXPECT_DOUBLE_EQ(run.parameters[1].estimate.deviation,
                   alone.damping_factor() * alone.identification.damping_deviation);
  EXPECT_EQ(run.status, alone.judgement.verdict);
  EXPECT_EQ(texts(run.objections), texts(alone.judgement.objections));
}

TEST(OneEngine, IdentifiesTheBeamAsItComparesIt) {
  Experiment e = simulated.experiment();
  e.model = {"beam", model_registry().completed("beam", {})};
  const Record record = simulated.record({Quantity::acceleration}, 0.02, 6);
  const ComparedRun alone = identify_with_model(e, measured_record("", record), {}, unwatched).runs.at(0),
                    run = compared(e, record).runs.at(0);
  for (std::size_t j = 0; j < run.parameters.size(); ++j) {
    EXPECT_EQ(run.parameters[j].estimate.value, alone.parameters[j].estimate.value);
    EXPECT_EQ(run.parameters[j].estimate.deviation, alone.parameters[j].estimate.deviation);
  }
}

// A smoother and a batch estimate are the engine's, not one model's. Oracle: at the last sample the smoother
// has no more to go by than the filter; the batch finds the same stiffness.
TEST(OneEngine, SmoothsAndBatchesTheBeamToo) {
  Experiment e = simulated.experiment();
  e.model = {"beam", model_registry().completed("beam", {})};
  e.smoother = "rts";
  e.estimator = "both";
  const Record record = simulated.record({Quantity::acceleration}, 0.02, 7).window(0, 4);
  const ComparedRun run = identify_with_model(e, measured_record("", record), {}, unwatched).runs.at(0);
  ASSERT_EQ(run.smoothed.size(), static_cast<std::size_t>(record.size()));
  EXPECT_LT((run.smoothed.back().mean - run.run.filtered.back().mean).norm(),
            1e-9 * run.run.filtered.back().mean.norm());
  ASSERT_TRUE(run.batch);
  ASSERT_EQ(run.batch->parameters.size(), run.parameters.size());
  const Estimate &filter = run.parameters[0].estimate, &batch = run.batch->parameters[0];
  EXPECT_NEAR(filter.value, batch.value, 0.1 * batch.deviation);
}

}  // namespace
}  // namespace beamid::experiments::one_engine_test
