// Oracles: the record's own window; what was put where the input is missing.
#include "experiments/record/prepare/prepared_record.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace beamid::experiments::known_inputs_test {
namespace {

constexpr double not_read = std::numeric_limits<double>::quiet_NaN();

Record with_gaps() {
  Record record;
  record.time = Eigen::VectorXd::LinSpaced(101, 0, 10);
  record.channels = {{Quantity::acceleration, "top"}, {Quantity::base_acceleration, "ground"}};
  record.samples = Eigen::MatrixXd::Random(2, 101);
  record.samples(0, 50) = not_read;  // a sensor's: none of its business
  record.samples.row(1).segment(30, 5).setConstant(not_read);
  record.samples(1, 100) = not_read;
  return record;
}

TEST(KnownInputs, LeavesTheLongestStretchAndSaysSo) {
  Record record = with_gaps();
  const Record expected = record.window(3.5, 9.9);
  EXPECT_EQ(take_known_inputs(record, MissingInput::leave_out),
            "Every input is known from 3.5 to 9.9 s: 64 % of the record, the longest of 2 such stretches. "
            "The rest is omitted.");
  EXPECT_EQ(record.time, expected.time);
  EXPECT_EQ(record.samples.row(1), expected.samples.row(1));
  EXPECT_EQ(take_known_inputs(record, MissingInput::leave_out), "");
}

TEST(KnownInputs, AreZeroWhereToldTo) {
  Record record = with_gaps();
  const Record before = record;
  EXPECT_EQ(
      take_known_inputs(record, MissingInput::zero),
      "Inputs are taken as 0 where they were not recorded, as missing_input states: 6 of 101 samples of "
      "'ground'.");
  EXPECT_EQ(record.samples.row(1).segment(30, 5).norm(), 0.0);
  EXPECT_EQ(record.samples(1, 100), 0.0);
  EXPECT_EQ(record.samples.row(1).head(30), before.samples.row(1).head(30));
}

TEST(KnownInputs, AreLeftMissingUnlessAskedAndRefusedWhereTooFewAreKnown) {
  Record record = with_gaps();
  EXPECT_EQ(take_known_inputs(record, MissingInput::refuse), "");
  EXPECT_EQ(record.size(), 101);
  for (Eigen::Index k = 0; k < 101; k += 10) record.samples(1, k) = not_read;
  try {
    take_known_inputs(record, MissingInput::leave_out);
    FAIL() << "nothing was refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "the longest stretch in which every input is known has 9 samples; expected 16 at least");
  }
}

}  // namespace
}  // namespace beamid::experiments::known_inputs_test
