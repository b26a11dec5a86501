// Readings that a sensor's range cut off, left out as NaN. Oracle: the truth the record was simulated with.
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/studies/identify/report.hpp"
#include "tests/experiments/identify/simulated_record.hpp"

namespace beamid::experiments::clipped_record_test {
namespace {

using Eigen::Index;

const test::SimulatedBeam simulated;

/// What lies beyond a share of the largest reading is missing.
Record clipped_at(double share, std::uint64_t seed) {
  Record record = simulated.record({Quantity::acceleration}, 0.01, seed);
  const double level = share * record.samples.cwiseAbs().maxCoeff();
  for (Index k = 0; k < record.size(); ++k)
    if (std::abs(record.samples(0, k)) > level) record.samples(0, k) = std::nan("");
  return record;
}

class ClippedRecord : public testing::TestWithParam<double> {};

// At 99.9 % of what the intervals are at 95 %; the modal analysis within four of its own deviations.
TEST_P(ClippedRecord, IsIdentifiedByWhatWasMeasured) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Record record = clipped_at(GetParam(), seed);
    const RecordIdentification r = identify_record(simulated.experiment(), record);
    ASSERT_EQ(r.judgement.verdict, ComparedRun::Status::converged) << r.judgement.objections[0].text;
    const Identification& i = r.identification;
    EXPECT_LT(std::abs(i.found.frequency_hz() - simulated.truth.frequency_hz()),
              3.29 * r.frequency_factor() * i.frequency_deviation_hz);
    EXPECT_LT(std::abs(i.found.damping_ratio() - simulated.damping_ratio),
              3.29 * r.damping_factor() * i.damping_ratio_deviation);
    EXPECT_LT(std::abs(r.modal.damping_ratio - simulated.damping_ratio),
              4.0 * r.modal.damping_ratio_standard_deviation);
    EXPECT_NEAR(r.noise_deviation[0] / (0.01 * 0.012 * std::pow(simulated.mode.angular_frequency(), 2)), 1.0,
                0.1);
    EXPECT_GT(r.response_error_percent(record), 0.0);
    const Results results = report(simulated.experiment(), record, "clipped.csv", r);
    EXPECT_EQ(results.values["status"], "converged");
  }
}

INSTANTIATE_TEST_SUITE_P(Levels, ClippedRecord, testing::Values(0.9, 0.8, 0.5, 0.2));

// The same readings left in: what they are cut by is no motion of the mode, and whatever of it is at the
// mode's frequency, no interval is shorter than the filter's.
TEST(ClippedReadings, LeftInNeverMakeAnIntervalShorter) {
  for (const double share : {0.9, 0.5, 0.2}) {
    Record record = simulated.record({Quantity::acceleration}, 0.01, 4);
    const double level = share * record.samples.cwiseAbs().maxCoeff();
    record.samples = record.samples.cwiseMin(level).cwiseMax(-level);
    const RecordIdentification r = identify_record(simulated.experiment(), record);
    EXPECT_GE(r.interval_factor, 1.0) << share;
    EXPECT_GE(r.frequency_factor(), 1.0) << share;
    EXPECT_GE(r.damping_factor(), 1.0) << share;
  }
}

}  // namespace
}  // namespace beamid::experiments::clipped_record_test
