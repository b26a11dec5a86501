// Oracle: times made at a known rate and printed with a known rounding, by two printing rules.
#include "experiments/record/record_table.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace beamid::experiments::sampling_test {
namespace {

std::optional<SamplingFault> fault_of(const std::vector<std::string>& printed) {
  PrintedPrecision precision;
  std::vector<double> times;
  for (const std::string& token : printed) {
    times.push_back(std::stod(token));
    precision.add(token);
  }
  return find_sampling_fault(times, precision);
}

/// @param skipped a sample that is missing, -1 for none.
std::vector<std::string> printed(const char* format, double interval, int skipped) {
  std::vector<std::string> tokens;
  for (int i = 0; i < 3000; ++i)
    if (i != skipped) tokens.push_back(fmt::format(fmt::runtime(format), 0.3 + i * interval));
  return tokens;
}

TEST(Sampling, PrintedWithAnyRoundingIsRegular) {
  for (const char* format : {"{:.4f}", "{:.6f}", "{:.5g}", "{:.6g}", "{:.5e}", "{:.9e}", "{}"})
    for (const double interval : {31.0 / 51200, 1e-3, 1.0 / 3, 0.7})
      EXPECT_FALSE(fault_of(printed(format, interval, -1))) << format << " " << interval;
}

TEST(Sampling, WithASampleMissingIsIrregularUnderAnyRounding) {
  for (const char* format : {"{:.4f}", "{:.6f}", "{:.6g}", "{:.5e}", "{:.9e}", "{}"})
    for (const double interval : {31.0 / 51200, 1e-3}) {
      const auto fault = fault_of(printed(format, interval, 500));
      ASSERT_TRUE(fault) << format << " " << interval;
      EXPECT_EQ(fault->sample, 500u);
    }
}

TEST(Sampling, KnowsTheResolutionOfPrintedNumbers) {
  PrintedPrecision fixed, significant, scientific;
  for (const char* token : {"0.000000", "0.000605", "2.486660"}) fixed.add(token);
  for (const char* token : {"0", "0.00123457", "12.3457", "-123"}) significant.add(token);
  for (const char* token : {"1.2500E-03", "+2.5000e+01"}) scientific.add(token);
  EXPECT_DOUBLE_EQ(fixed.resolution(0.000605), 1e-6);
  EXPECT_DOUBLE_EQ(fixed.resolution(2.4), 1e-6);
  EXPECT_DOUBLE_EQ(significant.resolution(0.00123457), 1e-8);
  EXPECT_DOUBLE_EQ(significant.resolution(12.3), 1e-4);
  EXPECT_DOUBLE_EQ(scientific.resolution(1.25e-3), 1e-7);
  EXPECT_DOUBLE_EQ(scientific.resolution(25.0), 1e-3);
}

// Rows 700 to 729 and 900 of 3,000 at 100 Hz, printed to 0.01 s: such an interval of 0.31 s is no rounding.
TEST(Sampling, MissingRowsAreCountedWhereStampsArePrintedToWholeIntervals) {
  std::vector<std::string> tokens;
  for (int i = 0; i < 3000; ++i)
    if (!(i >= 700 && i < 730) && i != 900) tokens.push_back(fmt::format("{:.2f}", 0.01 * i));
  const auto fault = fault_of(tokens);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->sample, 700u);
  EXPECT_NE(fault->message.find("time 7.3 after 6.99: 30 rows are missing between them"), std::string::npos)
      << fault->message;
  EXPECT_NE(fault->message.find("31 at 2 places in all"), std::string::npos) << fault->message;
  EXPECT_NE(fault->message.find("malformed = \"missing\""), std::string::npos) << fault->message;
  EXPECT_NE(fault->message.find("missing_input = \"leave_out\""), std::string::npos) << fault->message;
}

// 78 Hz, printed to 0.01 s: steps of one and two hundredths.
TEST(Sampling, StampsThatAreRoundedToTheirIntervalLackNoRows) {
  const auto fault = fault_of(printed("{:.2f}", 1.0 / 78.0, -1));
  ASSERT_TRUE(fault);
  EXPECT_NE(fault->message.find("printed this coarsely"), std::string::npos) << fault->message;
}

// A clock's seconds without their decimals: 100 samples share each stamp.
TEST(Sampling, StampsPrintedWithoutTheirDecimalsAreSaidToBe) {
  const auto fault = fault_of([] {
    std::vector<std::string> tokens;
    for (int i = 0; i < 1000; ++i) tokens.push_back(fmt::format("{}", 1700000000 + i / 100));
    return tokens;
  }());
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->message,
            "time 1700000000 after 1700000000; expected increasing times (times printed this coarsely need "
            "the sampling rate: --rate HZ, or record.sampling_rate_hz)");
}

}  // namespace
}  // namespace beamid::experiments::sampling_test
