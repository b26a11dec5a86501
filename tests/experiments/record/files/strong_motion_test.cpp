// Records of COSMOS, CSMIP and SMC. Oracle: the numbers written into the files, by hand from the formats'
// descriptions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/record/read_record.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/record/files/damaged_file.hpp"

namespace beamid::experiments::strong_motion_test {
namespace {

using testing::ElementsAre, testing::HasSubstr;

/// Real headers with the interval at its place, the 62nd.
std::string real_header(const std::string& interval_ms) {
  std::string text = "  66 Real-header values follow on  11 lines, Format= (6F13.6)\n";
  for (int k = 1; k <= 66; ++k) {
    const std::string value = k == 62 ? interval_ms : k == 34 ? "0.005000" : "-999.000000";
    text += std::string(13 - value.size(), ' ') + value + (k % 6 == 0 ? "\n" : "");
  }
  return text;
}

std::string cosmos_channel(const std::string& number, const std::string& numbers,
                           const std::string& unit = "cm/sec2(04)") {
  return "Corrected acceleration    (Format v01.20 with 13 text lines) Src: x.v0\n"
         "Station of 12 storeys\n"
         "Sta Cha:  " +
         number +
         ": 340 deg (Rcrdr Chan  1) Location: Roof\n"
         "  10 Integer-header values follow on   1 lines, Format= (10I8)\n"
         "       2       1       4     120       1    -999    -999   23075     123    -999\n" +
         real_header("10.000000") +
         "  1 Comment line(s) follow, each starting with a \"|\":\n"
         " | 5 6 7\n"
         "      3  acceleration pts, approx    0 secs, units=" +
         unit + ",Format=(2F10.5)\n" + numbers +
         "      3  velocity     pts, approx    0 secs, units=cm/sec (05),Format=(2F10.5)\n"
         "   9.00000   9.00000\n   9.00000\nEnd-of-data for Chan  1 acceleration\n";
}

TEST(StrongMotion, OfCosmosHasAllChannelsInSiUnits) {
  const TemporaryFile file("roof.v2", cosmos_channel("1", "-100.00000 200.00000\n    .5    \n") +
                                          cosmos_channel("7", "   1.00000   2.00000\n   3.00000\n"));
  const Record record = read_record(file.path());
  ASSERT_EQ(record.size(), 3);
  EXPECT_THAT(record.channel_names(), ElementsAre("chan_1", "chan_7"));
  EXPECT_LT(
      (record.samples - (Eigen::MatrixXd(2, 3) << -1.0, 2.0, 0.005, 0.01, 0.02, 0.03).finished()).norm(),
      1e-15);
  EXPECT_NEAR(record.time[2], 0.02, 1e-15);
  EXPECT_THAT(record.remarks, testing::Contains(HasSubstr("2 series of other quantities than acceleration")));
}

TEST(StrongMotion, OfCsmipStatesItsIntervalBesideTheData) {
  const TemporaryFile file(
      "x.v2",
      "Corrected accelerogram   89146-L2500-12044.02       Chan  1: 360 Deg     from\nStation No. 89146\n"
      "Chan  3: 360 Deg\n    1  100    1    3    3  200\n"
      " 4 points of accel data equally spaced at  .005 sec, in cm/sec2. (3f10.6)\n"
      " -1.000000  2.000000-33.000000\n  4.000000\n");
  const Record record = read_record(file.path());
  ASSERT_EQ(record.size(), 4);
  EXPECT_THAT(record.channel_names(), ElementsAre("chan_3"));
  EXPECT_NEAR(record.samples(0, 2), -0.33, 1e-15);
  EXPECT_NEAR(record.time[3], 0.015, 1e-15);
}

std::string smc(const std::string& numbers) {
  std::string text = "2 CORRECTED ACCELEROGRAM\n*\nSAF0A\n";
  for (int k = 4; k <= 11; ++k) text += "*\n";
  for (int k = 1; k <= 48; ++k)
    text += (k == 16   ? "         1"
             : k == 17 ? "         5"
                       : "    -32768") +
            std::string(k % 8 == 0 ? "\n" : "");
  for (int k = 1; k <= 50; ++k)
    text += (k == 2 ? "  0.2000000E+03" : "  0.1700000E+39") + std::string(k % 5 == 0 ? "\n" : "");
  return text + "|comment 1 2 3\n" + numbers;
}

TEST(StrongMotion, OfSmcHasCellsWithoutBlanks) {
  const TemporaryFile file("x.smc", smc(" 1.5057E+0-2.2223E+0-1.9234E+1 1.0000E-1-3.0000E+0\n"));
  const Record record = read_record(file.path());
  ASSERT_EQ(record.size(), 5);
  EXPECT_NEAR(record.samples(0, 1), -0.022223, 1e-15);
  EXPECT_NEAR(record.samples(0, 2), -0.19234, 1e-15);
  EXPECT_NEAR(record.time[4], 0.02, 1e-15);
}

TEST(StrongMotion, ThatIsCutOrHasNoScaleIsRefused) {
  const auto error = [](const std::string& text) {
    const TemporaryFile file("x.v2", text);
    return input_error_of(file, [&] { read_record(file.path()); });
  };
  EXPECT_THAT(error(smc(" 1.5057E+0\n")), HasSubstr("the file ends after 1 of 5 numbers"));
  EXPECT_THAT(error(smc(" 1.5057E+0  x\n")), HasSubstr("'x'; expected a number in 10 characters"));
  EXPECT_THAT(error(cosmos_channel("1", "   1.00000   2.00000\n   3.00000\n", "counts (50)")),
              HasSubstr("unit 'counts'; expected cm/sec2"));
}

}  // namespace
}  // namespace beamid::experiments::strong_motion_test
