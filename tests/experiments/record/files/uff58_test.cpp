// Universal Files, dataset 58: what is read, what is refused.
// Oracles: the numbers written into the files, by hand from the formats' descriptions or by the libraries.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "experiments/record/read_record.hpp"
#include "experiments/record/record_table.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/record/files/damaged_file.hpp"
#include "tests/experiments/record/files/written_record.hpp"

namespace beamid::experiments::uff58_test {
namespace {

using testing::HasSubstr;

std::string records_6_to_11(int node, int ordinate, int points, bool even, const char* unit,
                            const char* abscissa_unit = "s", double step = 0.01) {
  char line[200];
  std::string text;
  std::snprintf(line, sizeof(line), "%5d%10d%5d%10d %10s%10d%4d %10s%10d%4d\n", 1, 0, 0, 0, "NONE", node, 3,
                "NONE", 0, 0);
  text += line;
  std::snprintf(line, sizeof(line), "%10d%10d%10d%13.5e%13.5e%13.5e\n", ordinate, points, even ? 1 : 0, 0.0,
                even ? step : 0.0, 0.0);
  text += line;
  std::snprintf(line, sizeof(line), "%10d%5d%5d%5d %-20s %-20s\n", 17, 0, 0, 0, "Time", abscissa_unit);
  text += line;
  std::snprintf(line, sizeof(line), "%10d%5d%5d%5d %-20s %-20s\n", 12, 0, 0, 0, "NONE", unit);
  text += line;
  for (int k = 0; k < 2; ++k) text += "         0    0    0    0 NONE                 NONE                \n";
  return text;
}

std::string identification() {
  return "Hammer test\nNONE\n21-NOV-26 10:00:00\nNONE\nNONE\n";
}

std::string ascii_58(int node, int ordinate, bool even, const char* unit, double (*signal)(int)) {
  std::string text =
      "    -1\n    58\n" + identification() + records_6_to_11(node, ordinate, written_samples, even, unit);
  int fields = 0;
  const int in_row = ordinate == 2 ? 6 : 4;
  const auto put = [&](const std::string& number) {
    text += number;
    if (++fields % in_row == 0) text += "\n";
  };
  for (int k = 0; k < written_samples; ++k) {
    if (!even) put(printed("%13.5E", 0.01 * k));
    put(printed(ordinate == 2 ? "%13.5E" : "%20.12E", signal(k)));
  }
  return text + (fields % in_row ? "\n" : "") + "    -1\n";
}

/// @param order 1: little endian, 2: big endian.
std::string binary_58(int node, int ordinate, bool even, int order, const char* unit, double (*signal)(int)) {
  std::string data;
  const auto put = [&](double value) {
    char raw[8];
    const std::size_t width = ordinate == 2 ? 4 : 8;
    const auto single = static_cast<float>(value);
    if (ordinate == 2)
      std::memcpy(raw, &single, width);
    else
      std::memcpy(raw, &value, width);
    if (order == 2) std::reverse(raw, raw + width);
    data.append(raw, width);
  };
  for (int k = 0; k < written_samples; ++k) {
    if (!even) put(0.01 * k);
    put(signal(k));
  }
  char line[200];
  std::snprintf(line, sizeof(line), "    -1\n%6d%c%6d%6d%12d%12d%6d%6d%12d%12d\n", 58, 'b', order, 2, 11,
                static_cast<int>(data.size()), 0, 0, 0, 0);
  return line + identification() + records_6_to_11(node, ordinate, written_samples, even, unit) + data +
         "\n    -1\n";
}

TEST(Uff58Reader, ReadsAsciiOfBothPrecisionsAndSpacings) {
  for (const int ordinate : {2, 4})
    for (const bool even : {true, false}) {
      SCOPED_TRACE(testing::Message() << ordinate << " " << even);
      const TemporaryFile file("test.uff", "    -1\n   151\nmodel\nanother dataset\n    -1\n" +
                                               ascii_58(1, ordinate, even, "g", first_signal) +
                                               ascii_58(7, ordinate, even, "N", second_signal));
      const Record record = read_record(file.path());
      expect_both(record, ordinate == 2 ? 1e-5 : 1e-11);
      EXPECT_EQ(record.channels[1].name, "7:+Z");
    }
}

TEST(Uff58Reader, ReadsBinaryOfBothByteOrders) {
  for (const int order : {1, 2})
    for (const int ordinate : {2, 4})
      for (const bool even : {true, false}) {
        SCOPED_TRACE(testing::Message() << order << " " << ordinate << " " << even);
        const TemporaryFile file("test.unv", binary_58(1, ordinate, even, order, "g", first_signal) +
                                                 binary_58(2, ordinate, even, order, "N", second_signal));
        expect_both(read_record(file.path()), ordinate == 2 ? 1e-6 : 1e-13);
      }
}

// Oracle: the same numbers in another unit of time; frequencies were wrong by 1000.
TEST(Uff58Reader, TakesTheUnitOfTheAbscissa) {
  const auto file_of = [](const char* unit, bool even) {
    return "    -1\n    58\n" + identification() + records_6_to_11(1, 2, 3, even, "g", unit, 4.0) +
           (even ? "  1.00000E+00  2.00000E+00  3.00000E+00\n"
                 : "  0.00000E+00  1.00000E+00  4.00000E+00  2.00000E+00  8.00000E+00  3.00000E+00\n") +
           "    -1\n";
  };
  for (const bool even : {true, false}) {
    const TemporaryFile milli("ms.uff", file_of("ms", even)), plain("s.uff", file_of("", even)),
        other("deg.uff", file_of("deg", even)), minutes("min.uff", file_of("min", even));
    EXPECT_NEAR(read_record(milli.path()).interval(), 0.004, 1e-15);
    EXPECT_NEAR(read_record(plain.path()).interval(), 4.0, 1e-15);
    EXPECT_NEAR(read_record(minutes.path()).interval(), 240.0, 1e-12);
    for (const char* unit : {"s", "SEC", "Seconds", "NONE"}) {
      const TemporaryFile old("old.uff", file_of(unit, even));
      EXPECT_NEAR(read_record(old.path()).interval(), 4.0, 1e-15) << unit;
    }
    EXPECT_EQ(input_error_of(other, [&] { read_record(other.path()); }),
              "deg.uff: the abscissa of '1:+Z' is in 'deg'; expected times in s, ms, us, or record.time or "
              "record.sampling_rate_hz in the configuration");
    RecordFormat stated;
    stated.sampling_rate = 10.0;
    if (even) {
      EXPECT_NEAR(read_record(other.path(), stated).interval(), 0.1, 1e-15);
    }
  }
}

// 4000 datasets of one name took 57 s: the names (2), (3), ... were sought from the start for each.
TEST(Uff58Reader, NumbersManyDatasetsOfOneName) {
  const std::string one = "    -1\n    58\n" + identification() + records_6_to_11(1, 2, 3, true, "g") +
                          "  1.00000E+00  2.00000E+00  3.00000E+00\n    -1\n";
  std::string all;
  for (int k = 0; k < 4000; ++k) all += one;
  const TemporaryFile file("many.uff", all);
  const RecordTable table = read_table(file.path(), {});
  ASSERT_EQ(table.names.size(), 4000u);
  EXPECT_EQ(table.names[0], "1:+Z");
  EXPECT_EQ(table.names[3999], "1:+Z (4000)");
}

// Two datasets of one test, of which the second stopped earlier.
TEST(Uff58Reader, CutsDatasetsOfOtherLengthsToTheirCommonPart) {
  std::string shorter = ascii_58(2, 4, true, "m/s^2", second_signal);
  constexpr int kept = written_samples - 4;  // a row of four is left out
  const std::string points = fmt::format("{:10d}{:10d}", 4, written_samples);
  shorter.replace(shorter.find(points), points.size(), fmt::format("{:10d}{:10d}", 4, kept));
  const std::size_t end = shorter.rfind("    -1"), last_row = shorter.rfind('\n', end - 2) + 1;
  shorter.erase(last_row, end - last_row);
  const TemporaryFile file("two.uff", ascii_58(1, 4, true, "m/s^2", first_signal) + shorter);
  const Record record = read_record(file.path());
  ASSERT_EQ(record.size(), kept);
  ASSERT_EQ(record.channels.size(), 2u);
  EXPECT_NEAR(record.samples(1, kept - 1), second_signal(kept - 1), 1e-12);  // of E20.12
  ASSERT_EQ(record.objections.size(), 1u);
  EXPECT_THAT(record.objections[0].text,
              HasSubstr(fmt::format("{} to {} samples; the first {}", kept, written_samples, kept)));
}

TEST(Uff58Reader, ReadsNumbersThatTouch) {
  std::string text = "    -1\n    58\n" + identification() + records_6_to_11(1, 2, 3, true, "g");
  const TemporaryFile file("test.uff", text + "-1.00000E+000-2.00000E+000-3.00000E+000\n    -1\n");
  EXPECT_EQ(read_record(file.path()).samples, 9.80665 * Eigen::RowVector3d(-1, -2, -3));
}

TEST(Uff58Reader, RefusesWhatItCannotRead) {
  std::string cut = ascii_58(1, 4, true, "g", first_signal);
  const TemporaryFile short_file("cut.uff", cut.substr(0, cut.size() / 2));
  EXPECT_THAT(input_error_of(short_file, [&] { read_record(short_file.path()); }), HasSubstr("expected 40"));
  const TemporaryFile none("none.uff", "    -1\n   151\nmodel\n    -1\n");
  EXPECT_EQ(input_error_of(none, [&] { read_record(none.path()); }),
            "none.uff: no real time response among 0 datasets 58; expected one");
  const TemporaryFile volts("volts.uff", ascii_58(1, 4, true, "V", first_signal));
  EXPECT_EQ(
      input_error_of(volts, [&] { read_record(volts.path()); }),
      "volts.uff: no unit states what is measured: '1:+Z' [V]; expected --column N --quantity acceleration "
      "--unit g, or record.channels in the "
      "configuration");
}

TEST(Uff58Reader, RefusesABeginningSoLateThatItsIntervalIsLost) {
  std::string late = ascii_58(1, 4, true, "g", first_signal);
  const std::string beginning = printed("%13.5e", 0.0);
  late.replace(late.find(beginning), beginning.size(), printed("%13.5e", 5e14));
  const TemporaryFile file("late.uff", late);
  EXPECT_EQ(input_error_of(file, [&] { read_record(file.path()); }),
            "late.uff: begins at 5e+14 s, where an interval of 0.01 s is lost in rounding; expected times "
            "that increase");
}

TEST(Uff58Reader, ReadsOrRefusesDamagedFiles) {
  expect_read_or_refused("fuzz.uff",
                         ascii_58(1, 4, true, "g", first_signal) + ascii_58(2, 2, false, "N", second_signal),
                         {}, 3, 300);
  expect_read_or_refused("fuzz.unv", binary_58(1, 4, false, 2, "g", first_signal), {}, 4, 300);
}

}  // namespace
}  // namespace beamid::experiments::uff58_test
