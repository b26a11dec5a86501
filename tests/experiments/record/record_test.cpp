// Oracle: the samples written down here.
#include "experiments/record/record.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace beamid::experiments::record_test {
namespace {

// 101 samples from 2 s at 50 Hz; displacement 0, 1, 2, ... and acceleration 0, -1, -2, ...
Record ramp() {
  Record record;
  record.time = Eigen::VectorXd::LinSpaced(101, 2.0, 4.0);
  record.samples.resize(2, 101);
  record.samples.row(0) = Eigen::RowVectorXd::LinSpaced(101, 0.0, 100.0);
  record.samples.row(1) = -record.samples.row(0);
  record.channels = {{Quantity::displacement, "tip"}, {Quantity::acceleration, "tip"}};
  return record;
}

std::string message_of(const auto& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(Record, KnowsItsInterval) {
  EXPECT_NEAR(ramp().interval(), 0.02, 1e-15);
  EXPECT_EQ(ramp().size(), 101);
}

TEST(Record, FindsAChannelByItsQuantity) {
  const Record record = ramp();
  EXPECT_EQ(record.channel(Quantity::acceleration), record.samples.row(1).transpose());
  EXPECT_THAT(message_of([&] { record.channel(Quantity::velocity); }), testing::HasSubstr("velocity"));
}

TEST(Record, CutsAWindowWithBothEnds) {
  const Record part = ramp().window(2.5, 3.5);
  ASSERT_EQ(part.size(), 51);
  EXPECT_NEAR(part.time[0], 2.5, 1e-12);
  EXPECT_NEAR(part.time[50], 3.5, 1e-12);
  EXPECT_EQ(part.samples(0, 0), 25.0);
  EXPECT_EQ(part.samples(1, 50), -75.0);
  EXPECT_EQ(part.channels.size(), 2u);
}

TEST(Record, AllowsHalfAnIntervalAtTheWindowsEnds) {
  // Windows are written with rounded times: 1.995 s means the sample at 2 s.
  EXPECT_EQ(ramp().window(1.995, 4.005).size(), 101);
  EXPECT_EQ(ramp().window(2.509, 3.491).size(), 51);
}

TEST(Record, RefusesWindowsThatLeaveItOrHoldTooLittle) {
  const Record record = ramp();
  const double nan = std::nan("");
  for (const auto& [from, to] :
       {std::pair{1.9, 3.0}, {3.0, 4.1}, {5.0, 6.0}, {3.0, 3.1}, {3.5, 2.5}, {nan, 3.0}, {3.0, nan}})
    EXPECT_THAT(message_of([&, from = from, to = to] { record.window(from, to); }),
                testing::AllOf(testing::HasSubstr("window"), testing::HasSubstr("from 2 to 4 s")))
        << from << " to " << to;
}

TEST(Quantity, HasItsNameAndUnit) {
  EXPECT_STREQ(si_unit(Quantity::displacement), "m");
  EXPECT_STREQ(si_unit(Quantity::velocity), "m/s");
  EXPECT_STREQ(si_unit(Quantity::acceleration), "m/s2");
  EXPECT_STREQ(si_unit(Quantity::force), "N");
  EXPECT_STREQ(si_unit(Quantity::strain), "m/m");
  EXPECT_STREQ(to_string(Quantity::acceleration), "acceleration");
}

}  // namespace
}  // namespace beamid::experiments::record_test
