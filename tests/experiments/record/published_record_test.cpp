// Forms of record files that people have published. Oracle: what was written.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "experiments/record/read_record.hpp"
#include "experiments/record/units.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/record/recognised_text.hpp"

namespace beamid::experiments::published_record_test {
namespace {

using testing::HasSubstr;

// Numbers without order: neither columns nor rows show where the series goes on.
double scattered(int k) {
  return 0.01 * ((7919 * k + 13) % 101 - 50);
}

TEST(PublishedRecord, IsOneSeriesWhereItsPointsAreCounted) {
  for (const char* const head :
       {"UNCORRECTED ACCELERATION          UNIT: CM/SEC/SEC\nNO. OF POINTS:  240  EQUALLY SPACED INTERVALS "
        "OF:  "
        "0.005  SEC\nSITE CONDITION: SOIL\n\n",
        "#El Centro\n#240 points at equal spacing of 0.005 sec\n#The units are (Gal)\n"}) {
    std::string text = head;
    for (int k = 0; k < 240; ++k) text += fmt::format(" {:9.4f}{}", scattered(k), k % 8 == 7 ? "\n" : "");
    const Record record = recognised(text);
    ASSERT_EQ(record.samples.rows(), 1) << head;
    ASSERT_EQ(record.size(), 240) << head;
    EXPECT_NEAR(record.interval(), 0.005, 1e-12) << head;
    EXPECT_NEAR(record.samples(0, 9), 0.01 * scattered(9), 1e-12) << head;
  }
}

// Two sensors that take turns: their numbers are no columns of one.
TEST(PublishedRecord, OfSeveralSensorsKeepsTheAccelerations) {
  const auto text_of = [](const char* other) {
    std::string text;
    for (int k = 0; k < 60; ++k) {
      text += fmt::format("{}\tACC\t{:.4f}\t{:.4f}\t9.81{}\n", 8 * k, std::sin(0.3 * k),
                          0.5 * std::sin(0.4 * k), k % 10);
      if (k % 3 == 0) text += fmt::format("{}\t{}\t5.0\t6.0\t7.0\n", 8 * k + 1, other);
    }
    return text;
  };
  RecordFormat format;
  format.time = ColumnDescription{Quantity::acceleration, "", 1, 1e-3};
  format.channels = {{Quantity::acceleration, "", 3, 1.0}};
  for (const char* const other : {"GYR", "PRX", "LIGHT"}) {
    const Record record = recognised(text_of(other), format);
    ASSERT_EQ(record.size(), 60) << other;
    EXPECT_NEAR(record.samples(0, 7), std::sin(2.1), 1e-4) << other;
  }
  std::string others = text_of("GYR");
  for (std::size_t at = 0; (at = others.find("ACC", at)) != others.npos;) others.replace(at, 3, "MAG");
  EXPECT_THAT(question_of(others), HasSubstr("rows of several sensors, 'GYR', 'MAG', none of them"));
}

TEST(PublishedRecord, WithAGyroscopeTakesTheAccelerometerAlone) {
  std::string text = "# Config: data_rate = 2000.0 Hz, acc_range = 4 g\ncount,a_x,a_y,g_x,g_y\n";
  for (int k = 0; k < 60; ++k)
    text +=
        fmt::format("{},{:.5f},{:.5f},-249.{},{:.3f}\n", k, std::sin(0.3 * k), std::cos(0.2 * k), k % 7, 3.0);
  const Record record = recognised(text);
  ASSERT_EQ(record.channels.size(), 2u);
  EXPECT_EQ(record.channels[1].name, "a_y");
}

TEST(PublishedRecord, HasNoNamesInKeysWithoutValues) {
  std::string text = "SAMPLING_INTERVAL_S: 0.005000\nUNITS: cm/s^2\nUSER3: \nUSER4: \nUSER5: \n";
  for (int k = 0; k < 60; ++k) text += fmt::format("{:.6f}\n", scattered(k));
  const Record record = recognised(text);
  EXPECT_EQ(record.channels.at(0).name, "column_1");
  EXPECT_NEAR(record.samples(0, 3), 0.01 * scattered(3), 1e-12);
}

TEST(PublishedRecord, BeginsWithCellsThatHoldNothing) {
  for (const char* const head : {"x_axis,channel_2,channel_4\n", "x-axis,2,4\nsecond,Volt,Volt\n"}) {
    std::string text = head;
    for (int k = 0; k < 60; ++k)
      text += k < 8 ? fmt::format("{:.7f},,\n", 0.00078125 * k)
                    : fmt::format("{:.7f},{:.5f},{:.5f}\n", 0.00078125 * k, scattered(k), scattered(3 * k));
    RecordFormat format;
    format.malformed = MalformedRows::as_missing;
    const Record record = recognised(text, format);
    ASSERT_EQ(record.samples.rows(), 2);
    EXPECT_NEAR(record.samples(1, record.size() - 1), scattered(177), 1e-9);
  }
}

TEST(PublishedRecord, OfDaysIsNoVibration) {
  std::string text = "Date,Open,High\n";
  for (int k = 1; k < 28; ++k)
    text += fmt::format("2002-07-{:02d},{:.2f},{:.2f}\n", k, 160 + scattered(k), 163.0 + k % 3);
  EXPECT_THAT(question_of(text), HasSubstr("column 1 holds dates without times of day"));
}

TEST(PublishedRecord, HasNoChannelOfDatesPastMidnight) {
  std::string text;
  for (int k = 0; k < 60; ++k)
    text += fmt::format("2026-11-{},{}:{:06.3f},{:.4f}\n", k < 30 ? 26 : 27, k < 30 ? "23:59" : "00:00",
                        k < 30 ? 59.7 + 0.01 * k : 0.01 * (k - 30), scattered(k));
  const Record record = recognised(text);
  EXPECT_EQ(record.channels.size(), 1u);
  EXPECT_NEAR(record.interval(), 0.01, 1e-9);
}

TEST(PublishedRecord, ThatBeginsWithABraceIsNoJson) {
  std::string text = "{System 1};;\nZeit [s];Messwert {1} [mm];\n";
  for (int k = 0; k < 60; ++k) text += fmt::format("{:.3f};{:.4f};\n", 0.01 * k, scattered(k));
  for (char& sign : text) sign = sign == '.' ? ',' : sign;
  EXPECT_THAT(question_of(text), testing::StartsWith("read at 100"));
}

// A decay after two hits of a hammer, whose force droops by 1 % and rebounds, without a header or under names
// that state no quantity; a name that states one keeps the channel.
TEST(PublishedRecord, OfAHammerHasNoResponseInItsForce) {
  const auto text_of = [](const std::string& header) {
    std::string text = header;
    for (int k = 0; k < 2000; ++k) {
      const double t = 1e-3 * k, since = t - 0.02, again = t - 0.11;
      const double pulses =
          std::exp(-std::pow(since / 1.5e-3, 2)) + 0.3 * std::exp(-std::pow(again / 1.5e-3, 2));
      const double motion = since > 0.0 ? std::exp(-2.0 * since) * std::sin(80.0 * since) : 0.0;
      text += fmt::format("{:.3f}\t{:.6f}\t{:.4f}\n", t, motion,
                          90.0 * pulses - (since > 0.0 ? 0.9 * std::exp(-since) : 0.0));
    }
    return text;
  };
  for (const char* const header : {"", "time [s]\tch1\tch2\n"}) {
    const Record record = recognised(text_of(header));
    ASSERT_EQ(record.channels.size(), 1u) << header;
    EXPECT_THAT(record.remarks, testing::Contains(testing::HasSubstr("as of a hammer's force, omitted: '")))
        << header;
    EXPECT_NEAR(record.samples(0, 40), std::exp(-0.04) * std::sin(1.6), 1e-6) << header;
  }
  EXPECT_EQ(recognised(text_of("time [s]\tAcc 1 [g]\tAcc 2 [g]\n")).channels.size(), 2u);
}

}  // namespace
}  // namespace beamid::experiments::published_record_test
