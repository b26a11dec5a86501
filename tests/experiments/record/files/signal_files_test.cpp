// Sound files, MiniSEED, SAC and PEER's records, byte by byte as their formats are defined, whole and cut
// short.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "experiments/record/read_record.hpp"
#include "experiments/record/record_table.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::signal_files_test {
namespace {

using testing::HasSubstr;

constexpr int count = 64, rate = 400;

std::int32_t sample(int k) {
  return (k * 37) % 101 - 50;
}

template <class Number>
std::string bytes_of(Number value, bool big = false) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (big) std::ranges::reverse(bytes);
  return bytes;
}

std::string wave() {
  std::string samples;
  for (int k = 0; k < count; ++k)
    samples +=
        bytes_of(static_cast<std::int16_t>(sample(k) * 100)) + bytes_of(static_cast<std::int16_t>(k % 7));
  const std::string format = "fmt " + bytes_of<std::uint32_t>(16) + bytes_of<std::uint16_t>(1) +
                             bytes_of<std::uint16_t>(2) + bytes_of<std::uint32_t>(rate) +
                             bytes_of<std::uint32_t>(4 * rate) + bytes_of<std::uint16_t>(4) +
                             bytes_of<std::uint16_t>(16),
                    data = "data" + bytes_of(static_cast<std::uint32_t>(samples.size())) + samples;
  return "RIFF" + bytes_of(static_cast<std::uint32_t>(4 + format.size() + data.size())) + "WAVE" + format +
         data;
}

std::string sac(bool big, std::int32_t measured = 7) {
  std::string header;
  for (int word = 0; word < 70; ++word)
    header += bytes_of(word == 0 ? 1.0F / rate : word == 5 ? 0.0F : -12345.0F, big);
  for (int word = 70; word < 110; ++word)
    header += bytes_of<std::int32_t>(word == 76    ? 6
                                     : word == 79  ? count
                                     : word == 85  ? 1
                                     : word == 86  ? measured
                                     : word == 105 ? 1
                                                   : -12345,
                                     big);
  std::string names = "LAB     ";
  while (names.size() < 192) names += "-12345  ";
  std::string samples;
  for (int k = 0; k < count; ++k) samples += bytes_of(static_cast<float>(sample(k)), big);
  return header + names + samples;
}

/// One record of 512 bytes with integers of 32 bits, and a blockette 1000 that says so.
/// @param first sample of it, of `length`
std::string miniseed(int first, int length) {
  const auto instant = static_cast<std::uint16_t>(first * 10000 / rate);  // of 0.1 ms
  std::string record = fmt::format("{:06}D LAB    HNZXX", first + 1);
  record += bytes_of<std::uint16_t>(2026, true) + bytes_of<std::uint16_t>(330, true) +
            std::string("\x0A\0\0\0", 4) + bytes_of(instant, true) +
            bytes_of(static_cast<std::uint16_t>(length), true) + bytes_of<std::int16_t>(rate, true) +
            bytes_of<std::int16_t>(1, true) + std::string("\0\0\0\1", 4) + bytes_of<std::int32_t>(0, true) +
            bytes_of<std::uint16_t>(64, true) + bytes_of<std::uint16_t>(48, true);
  record +=
      bytes_of<std::uint16_t>(1000, true) + bytes_of<std::uint16_t>(0, true) + std::string("\3\1\x9\0", 4);
  record.resize(64);
  for (int k = 0; k < length; ++k) record += bytes_of(sample(first + k), true);
  record.resize(512);
  return record;
}

std::string at2(const std::string& unit) {
  std::string text =
      "PEER NGA\nTest\nACCELERATION TIME SERIES IN UNITS OF " + unit + "\nNPTS=    64, DT=   .0025 SEC,\n";
  for (int k = 0; k < count; ++k)
    text += fmt::format("{:15.7E}{}", 0.001 * sample(k), k % 5 == 4 ? "\n" : "");
  return text + "\n";
}

TEST(SignalFiles, GiveSamplesAndTheRateOfTheFile) {
  struct Case {
    const char* reader;
    std::string bytes;
    double unit;
    Quantity quantity;
  };
  for (const auto& [reader, bytes, unit, quantity] :
       {Case{"sound", wave(), 100.0 / 32768.0, Quantity::acceleration},
        Case{"sac", sac(false), 1.0, Quantity::velocity},
        Case{"sac", sac(true, 8), 1.0, Quantity::acceleration},
        Case{"miniseed", miniseed(0, count), 1.0, Quantity::acceleration},
        Case{"at2", at2("G"), 0.001 * 9.80665, Quantity::acceleration},
        Case{"at2", at2("CM/SEC/SEC"), 1e-5, Quantity::acceleration}}) {
    const TemporaryFile file("signal", bytes);
    EXPECT_EQ(reader_of(file.path(), {}), reader);
    const Record record = read_record(file.path(), {});
    ASSERT_EQ(record.size(), count) << reader;
    EXPECT_EQ(record.channels[0].quantity, quantity) << reader;
    EXPECT_NEAR(record.interval(), 1.0 / rate, 1e-9) << reader;
    for (int k = 0; k < count; ++k) EXPECT_NEAR(record.samples(0, k), unit * sample(k), 1e-6) << reader << k;
  }
}

TEST(SignalFiles, TakeAGapOfMiniSeedForMissingSamples) {
  const TemporaryFile file("signal", miniseed(0, 24) + miniseed(32, 32));
  const Record record = read_record(file.path(), {});
  ASSERT_EQ(record.size(), count);
  EXPECT_EQ(record.samples.array().isNaN().count(), 8);
  EXPECT_EQ(record.samples(0, 32), sample(32));
}

TEST(SignalFiles, AreRefusedWhereTheyAreCutShort) {
  for (const std::string& whole : {wave(), sac(false), miniseed(0, count), at2("G")})
    for (std::size_t length = 16; length + 16 < whole.size(); length += 37) {
      const TemporaryFile cut("signal", whole.substr(0, length));
      try {
        EXPECT_LE(read_record(cut.path(), {}).size(), count);
      } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("expected")) << length;
      }
    }
}

TEST(SignalFiles, OfOtherKindsAreNamed) {
  for (const auto& [beginning, words] : {std::pair{"\xD0\xCF\x11\xE0 and more", "Excel"},
                                         {"%PDF-1.4\n", "PDF"},
                                         {"TDSm....", "TDMS"},
                                         {"PK\x03\x04..[Content_Types].xml", "save its sheet as CSV"},
                                         {"{\"t\": {\"unit\": 1}}", "JSON"},
                                         {"<html></html>", "XML"}}) {
    const TemporaryFile file("other", beginning);
    EXPECT_THAT(input_error_of(file, [&] { read_record(file.path(), {}); }), HasSubstr(words));
  }
}

// Oracle: what was written. Both traces stood in one series; the second one begins a sample later.
TEST(TextOfSeismologicalServices, HoldsSeveralTraces) {
  std::string text =
      "TIMESERIES XX_ABC__HHZ_D, 40 samples, 100 sps, 2024-03-01T10:00:00.000000, SLIST, FLOAT, M/S\n";
  for (int k = 0; k < 40; ++k) text += fmt::format("{:.6f}{}", std::cos(0.3 * k), k % 6 == 5 ? "\n" : "  ");
  text +=
      "\nTIMESERIES XX_ABC__HNZ_D, 39 samples, 100 sps, 2024-03-01T10:00:00.010000, TSPAIR, FLOAT, Counts\n";
  for (int k = 1; k < 40; ++k) text += fmt::format("2024-03-01T10:00:00.{:02d}0000  {}\n", k, 7 * k % 11);
  const TemporaryFile file("traces.txt", text);
  const RecordTable table = read_table(file.path(), {});
  EXPECT_THAT(table.names, testing::ElementsAre("XX_ABC__HHZ_D", "acceleration XX_ABC__HNZ_D"));
  EXPECT_THAT(table.units, testing::ElementsAre("m/s", "counts"));
  ASSERT_EQ(table.rows(), 40u);
  EXPECT_NEAR(table.columns[0][1], std::cos(0.3), 1e-6);
  EXPECT_TRUE(std::isnan(table.columns[1][0]));
  EXPECT_EQ(table.columns[1][2], 3.0);
  EXPECT_DOUBLE_EQ(table.clock.value().interval, 0.01);
  const TemporaryFile cut("cut.txt", text.substr(0, 200));
  EXPECT_THAT(input_error_of(cut, [&] { read_table(cut.path(), {}); }), testing::HasSubstr("numbers follow"));
}

}  // namespace
}  // namespace beamid::experiments::signal_files_test
