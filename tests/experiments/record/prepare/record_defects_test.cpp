// Records with what laboratories put into them, as every command that reads a record gets them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/record/record.hpp"
#include "experiments/signal/toolbox.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::record_defects_test {
namespace {

using Eigen::Index, Eigen::VectorXd;
using testing::HasSubstr;

/// 10 s at 200 Hz of a decay at 5 Hz with a damping ratio of 0.5 %, 3 m/s2 at first.
VectorXd decay(const VectorXd& time) {
  const double omega = 10 * std::numbers::pi;
  return time.unaryExpr(
      [&](double t) { return 3 * std::exp(-0.005 * omega * t) * std::cos(omega * t + 0.4); });
}

Record made() {
  Record record;
  record.time = VectorXd::LinSpaced(2001, 0, 10);
  record.samples = (decay(record.time) + 0.003 * standard_normal(2001, 1, 0)).transpose();
  record.channels = {{Quantity::acceleration, "tip"}};
  return record;
}

/// Through a file, as commands take it.
PreparedRecord prepared(const Record& record, const RecordFormat& format = {}) {
  const TemporaryFile file("record.csv", "");
  write_record(record, file.path());
  return read_and_prepare(file.path(), format);
}

TEST(ReadAndPrepare, MakesClippedSamplesMissingAndWarns) {
  Record record = made();
  const Index beyond = (record.samples.array().abs() >= 2).count();
  record.samples = record.samples.cwiseMin(2).cwiseMax(-2).eval();
  const PreparedRecord found = prepared(record);
  EXPECT_EQ(found.record.samples.array().isNaN().count(), beyond);
  ASSERT_EQ(found.record.objections.size(), 1u);
  EXPECT_THAT(found.record.objections[0].text, HasSubstr("tip (acceleration): clipped at -2 and 2 m/s2"));
  RecordFormat later;
  later.window = {9.0, 10.0};
  EXPECT_TRUE(prepared(record, later).record.objections.empty());  // nothing is clipped there
}

TEST(ReadAndPrepare, LeavesAHealthyRecordAsItIs) {
  const Record record = made();
  const PreparedRecord found = prepared(record);
  EXPECT_TRUE(found.record.objections.empty());
  EXPECT_TRUE(found.record.samples.allFinite());
}

TEST(ReadAndPrepare, RefusesWhatIsMostlyClippedOrDead) {
  Record record = made();
  record.samples = record.samples.cwiseMin(0.3).cwiseMax(-0.3).eval();
  try {
    prepared(record);
    ADD_FAILURE() << "mostly clipped and taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("tip (acceleration): "));
    EXPECT_THAT(error.what(), HasSubstr("% of the samples"));
    EXPECT_THAT(error.what(), HasSubstr("clipped at -0.3 and 0.3"));
  }
  record.samples.setConstant(0.2);
  EXPECT_THROW(prepared(record), InputError);
}

// Oracle: the decay that was not clipped, whose noise is 0.003.
TEST(Analysable, FillsWhatWasClippedAsIfItHadBeenRead) {
  for (const double limit : {2.5, 2.0, 1.2}) {
    Record record = made();
    const VectorXd clean = decay(record.time);
    record.samples = (record.samples.array().abs() >= limit).select(std::nan(""), record.samples).eval();
    const AnalysableRecord even = analysable(record);
    ASSERT_TRUE(even.record.samples.allFinite());
    const Index first = static_cast<Index>(std::lround((even.record.time[0] - record.time[0]) * 200));
    const VectorXd error = even.record.samples.row(0).transpose() - clean.segment(first, even.record.size());
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 0.03) << limit;  // 1 % of the largest reading
    EXPECT_LT(even.share, 1);
  }
}

TEST(Analysable, NeverCrossesAGap) {
  Record record = made();
  record.samples.middleCols(600, 100).setConstant(std::nan(""));
  AnalysableRecord even = analysable(record);
  EXPECT_DOUBLE_EQ(even.record.time[0], 3.5);
  EXPECT_EQ(even.record.size(), 1301);
  even = analysable(record, std::pair{0.0, 2.9});
  EXPECT_DOUBLE_EQ(even.record.time[0], 0.0);
  EXPECT_EQ(even.record.size(), 600);
}

TEST(Resample, LeavesGapsMissing) {
  Record record = made();
  std::vector<Index> kept;
  for (Index k = 0; k < record.size(); ++k)
    if (k < 500 || k >= 560) kept.push_back(k);
  record.time = record.time(kept).eval();
  record.time.array() += 0.001 * standard_normal(record.time.size(), 2, 0).array().tanh();
  record.samples = decay(record.time).transpose();
  const Record even = prepare(record, {{"resample", step_registry().completed("resample", {})}});
  const VectorXd clean = decay(even.time);
  for (Index k = 0; k < even.size(); ++k) {
    const bool gap = even.time[k] > record.time[499] + 1e-6 && even.time[k] < record.time[500] - 1e-6;
    ASSERT_EQ(std::isnan(even.samples(0, k)), gap) << even.time[k];
    if (!gap) {
      ASSERT_NEAR(even.samples(0, k), clean[k], 0.01) << even.time[k];
    }
  }
}

// Oracle: the same step on a record in which nothing was missing.
TEST(Prepare, FiltersWhatIsThereAndLeavesTheRestMissing) {
  Record record = made();
  const std::vector<Choice> steps{
      {"low_pass", step_registry().completed("low_pass", {{"corner_hz", 20.0}, {"zero_phase", true}})}};
  const Record whole = prepare(record, steps);
  record.samples.middleCols(1000, 12).setConstant(std::nan(""));
  const Record holed = prepare(record, steps);
  EXPECT_EQ(holed.samples.array().isNaN().count(), 12);
  for (Index k = 0; k < holed.size(); ++k)
    if (!std::isnan(holed.samples(0, k))) {
      ASSERT_NEAR(holed.samples(0, k), whole.samples(0, k), 0.01) << k;
    }
}

}  // namespace
}  // namespace beamid::experiments::record_defects_test
