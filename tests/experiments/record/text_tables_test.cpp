// Texts whose columns have to be put together: blocks, lines of channels, clocks in parts, keys above and
// below. Oracle: the decay that signal_rows() writes, 400 Hz, and the unit that the text states.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <string>

#include "experiments/record/read_record.hpp"
#include "experiments/record/units.hpp"
#include "tests/experiments/record/recognised_text.hpp"

namespace beamid::experiments::text_tables_test {
namespace {

using testing::HasSubstr;

constexpr int rows = 200;

double decay(int k) {
  return std::exp(-0.002 * k) * std::cos(0.08 * k);
}

void expect_decay(const std::string& text, std::size_t channels, double factor, double rate = 400.0) {
  const Record record = recognised(text);
  ASSERT_EQ(record.channels.size(), channels);
  ASSERT_EQ(record.size(), rows);
  EXPECT_NEAR(1.0 / record.interval(), rate, 1e-3 * rate);
  for (int k = 0; k < rows; k += 17) EXPECT_NEAR(record.samples(0, k), factor * decay(k), 2e-4 * factor);
}

std::string plain_rows(const char* form = "{:.5f}") {
  return signal_rows(rows, [&](int, double a) { return fmt::format(fmt::runtime(form), a); });
}

TEST(TextBlocks, ReadVariablesOfOctaveAndTheScalarsBesideThem) {
  const std::string head = "# Created by Octave 8.4.0, Thu Nov 26 10:00:00 2026 UTC <me@pc>\n",
                    rate = "# name: fs\n# type: scalar\n400\n\n\n",
                    unit = "# name: unit\n# type: string\n# elements: 1\n# length: 1\ng\n\n\n",
                    matrix = fmt::format("# name: acc\n# type: matrix\n# rows: {}\n# columns: 1\n{}\n\n",
                                         rows, plain_rows(" {:.6f}"));
  expect_decay(head + rate + matrix, 1, 1.0);
  expect_decay(head + matrix + rate, 1, 1.0);
  expect_decay(head + matrix + rate + unit, 1, standard_gravity);
  EXPECT_THAT(question_of(head + matrix), HasSubstr("--rate HZ"));
}

std::string trace(const char* name, const char* form, int samples) {
  std::string text =
      fmt::format("TIMESERIES {}, {} samples, 400 sps, 2026-11-26T10:00:00.000000, {}, FLOAT, M/S**2\n", name,
                  samples, form);
  for (int k = 0; k < samples; ++k)
    text += std::string(form) == "TSPAIR"
                ? fmt::format("2026-11-26T10:00:{:09.6f}  {:.6f}\n", k / 400.0, decay(k))
                : fmt::format("{:.6f}{}", decay(k), k % 6 == 5 || k + 1 == samples ? "\n" : "\t");
  return text;
}

TEST(TextBlocks, ReadTracesOfIrisSideBySide) {
  for (const char* const form : {"SLIST", "TSPAIR"}) {
    expect_decay(trace("XX_A__HNZ_D", form, rows), 1, 1.0);
    expect_decay(trace("XX_A__HNZ_D", form, rows) + trace("XX_A__HNE_D", form, rows), 2, 1.0);
  }
}

TEST(TextBlocks, ReadWaveformsOfGse2) {
  const std::string head =
      "WID2 2026/11/26 10:00:00.000 TST   HNZ      {}      200  400.000000   1.00e+00   1.000 NONE    -1.0  "
      "0.0\nSTA2            0.00000    0.00000 WGS-84       0.000 0.000\nDAT2\n";
  std::string numbers;
  double sum = 0.0;
  for (int k = 0; k < rows; ++k) {
    const double value = std::round(10000.0 * decay(k));
    numbers += fmt::format("{:.0f}{}", value, k % 10 == 9 ? "\n" : " "), sum += value;
  }
  expect_decay(fmt::format(fmt::runtime(head), "INT") + numbers + fmt::format("CHK2 {:.0f}\n", std::abs(sum)),
               1, 10000.0);
  EXPECT_THAT(question_of(fmt::format(fmt::runtime(head), "AU6") + numbers),
              HasSubstr("expected INT or CM6"));
}

TEST(TextBlocks, ReadBlocksOfGnuplotSideBySideOrAsk) {
  const auto block = [](int count) {
    return signal_rows(count, [](int k, double a) { return fmt::format("{:.4f} {:.5f}", k / 400.0, a); });
  };
  expect_decay("# t a\n" + block(rows) + "\n\n" + block(rows), 2, 1.0);
  EXPECT_THAT(question_of("# t a\n" + block(rows) + "\n\n" + block(rows - 20)),
              HasSubstr("a file for each block"));
}

TEST(TextTables, TurnLinesOfChannelsToColumns) {
  std::string times = "Time (s)", values = "X (g)";
  for (int k = 0; k < rows; ++k)
    times += fmt::format(",{:.4f}", k / 400.0), values += fmt::format(",{:.6f}", decay(k));
  expect_decay(times + "\n" + values + "\n", 1, standard_gravity);
}

TEST(TextTables, AddTheColumnsOfAClock) {
  const auto row = [](int k, double a) {
    const double seconds = 57.0 + k / 200.0;
    return fmt::format("13,{},{},{:.0f},{:.5f}", 58 + static_cast<int>(seconds) / 60,
                       static_cast<int>(seconds) % 60, std::fmod(seconds, 1.0) * 1000.0, a);
  };
  expect_decay("Hour,Minute,Second,Millisecond,ax\n" + signal_rows(rows, row), 1, 1.0, 200.0);
}

TEST(TextTables, ReadHoursMinutesAndSecondsInOneNumber) {
  expect_decay("UTC,ax\n" + signal_rows(rows,
                                        [](int k, double a) {
                                          const double seconds = 59.0 + k / 100.0;
                                          return fmt::format("10{:02}{:05.2f},{:.5f}",
                                                             static_cast<int>(seconds) / 60,
                                                             std::fmod(seconds, 60.0), a);
                                        }),
               1, 1.0, 100.0);
}

TEST(TextTables, LeaveOutDigitalLines) {
  expect_decay("x-axis,1,D0-D7\nsecond,Volt,\n" + signal_rows(rows,
                                                              [](int k, double a) {
                                                                return fmt::format("{:.4f},{:.5f},{}",
                                                                                   k / 400.0, a, k / 37 % 4);
                                                              }),
               1, 1.0);
}

TEST(TextTables, ReadKeysAboveAndBelowTheRows) {
  const std::string two =
      signal_rows(rows, [](int, double a) { return fmt::format("{:.6f},{:.6f}", a, -a); });
  expect_decay("Sample Rate,400\nUnits,g\n" + two, 2, standard_gravity);  // keys, no names
  expect_decay(
      "Device,AX3\nSample Rate,400\nGain,2.0\n" +
          signal_rows(rows, [](int k, double a) { return fmt::format("{:.4f},{:.5f}", k / 400.0, a); }),
      1, 1.0);
  expect_decay(plain_rows() + "fs = 400 Hz\n", 1, 1.0);
}

// A range is none of the unit.
TEST(TextTables, TakeNoRangeForAUnit) {
  const std::string counts =
      signal_rows(rows, [](int, double a) { return fmt::format("{:.0f}", 8192.0 * a); });
  for (const char* const range : {"# acc_range = 4 g", "# Range: 2 g", "Range,±16 g", "Full scale: 2 g"}) {
    const Record record = recognised(fmt::format("{}\nRate,400 Hz\n{}", range, counts));
    EXPECT_NEAR(record.samples(0, 0), 8192.0, 1.0) << range;
  }
}

TEST(TextTables, ReadCyrillicWordsAndUnits) {
  const auto row = [](int k, double a) { return fmt::format("{:.4f};{:.4f}", k / 400.0, 1000.0 * a); };
  expect_decay("Время, с;Ускорение, мм/с2\n" + signal_rows(rows, row), 1, 1.0);
  const std::string windows_1251 =
      "\xC2\xF0\xE5\xEC\xFF, \xF1;\xD3\xF1\xEA\xEE\xF0\xE5\xED\xE8\xE5, \xEC\xEC/\xF1"
      "2\n";
  expect_decay(windows_1251 + signal_rows(rows, row), 1, 1.0);
}

TEST(TextTables, NameTheColumnsOfASolutionOfRtklib) {
  const std::string form =
      "2026/11/26 10:00:{:06.3f}  {:.4f}  {:.4f}  1.2000  1  14  0.0021  0.0025  0.0061  0.0008 "
      "-0.0010 -0.0005  0.00  {:.1f}";
  const auto row = [&](int k, double a) {
    return fmt::format(fmt::runtime(form), k / 20.0, 12.3 + a, -4.1 + 0.5 * a, 50.0 + a);
  };
  const Record record = recognised(signal_rows(rows, row));
  ASSERT_EQ(record.channels.size(), 2u);  // the third does not move
  EXPECT_EQ(record.channels[0].quantity, Quantity::displacement);
  EXPECT_NEAR(record.samples(0, 0), 13.3, 1e-3);
}

}  // namespace
}  // namespace beamid::experiments::text_tables_test
