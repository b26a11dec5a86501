// Oracle: the oscillator that the force was put on, exactly.
#include "experiments/modal/mode_by_mode.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/identify/engine/analysis.hpp"
#include "tests/experiments/forced_oscillator.hpp"

namespace beamid::experiments::forced_mode_test {
namespace {

const Oscillator oscillator = Oscillator::from_frequency(1.08, 2.0 * std::numbers::pi * 3.4555, 0.02);

// The frequency that the beam leads to expect is 10 % off either way.
TEST(ForcedMode, IsFoundInARecordDrivenThroughout) {
  for (const double rate : {50.0, 400.0})
    for (const double expected : {0.9 * 3.4555, 1.1 * 3.4555}) {
      const Record record = test::driven_throughout(oscillator, 39, rate, 0.02, 7);
      const ForcedMode mode =
          forced_mode(record.samples.row(0).transpose(), record.samples.bottomRows(1), 1 / rate, expected);
      EXPECT_NEAR(mode.frequency_hz / 3.4555, 1.0, 0.002) << rate;
      EXPECT_NEAR(mode.damping_ratio / 0.02, 1.0, 0.1) << rate;
    }
}

TEST(ForcedMode, IsNotInventedWhereNoneIs) {
  const Record record = test::driven_throughout(oscillator, 39, 100, 0.02, 7);
  EXPECT_THROW(forced_mode(standard_normal(record.size(), 3, 5), record.samples.bottomRows(1), 0.01, 20.0),
               std::invalid_argument);
  EXPECT_THROW(forced_mode(record.samples.row(0).head(40).transpose(),
                           record.samples.bottomRows(1).leftCols(40), 0.01, 3.0),
               std::invalid_argument);
}

TEST(RecordedFrequency, IsAbsentWithItsReasonAndNeverAnException) {
  const Record record = test::driven_throughout(oscillator, 39, 50, 0.02, 7);
  const Eigen::VectorXd output = record.samples.row(0).transpose();
  for (const Eigen::Index inputs : {0, 1})
    for (const double expected : {1e-4, 3.4555, 24.9, 400.0}) {
      const RecordedFrequency found =
          recorded_frequency(output, record.samples.bottomRows(inputs), 0.02, expected);
      EXPECT_NE(found.value_hz.has_value(), !found.failure.empty()) << expected;
    }
}

}  // namespace
}  // namespace beamid::experiments::forced_mode_test
