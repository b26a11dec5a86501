// Texts with the same words and signs around the numbers of each row, rows of several sensors, and clocks
// that begin again. Oracle: the decay that is written, its instants and its unit.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "experiments/record/read_record.hpp"
#include "experiments/record/units.hpp"
#include "tests/experiments/record/recognised_text.hpp"

namespace beamid::experiments::patterned_text_test {
namespace {

using testing::HasSubstr;

constexpr int rows = 400;
constexpr double g = standard_gravity;

double decay(int k) {
  return std::exp(-0.002 * k) * std::cos(0.08 * k);
}

void expect_decay(const std::string& text, std::size_t channels, double factor, double rate = 100.0,
                  Quantity quantity = Quantity::acceleration) {
  const Record record = recognised(text);
  ASSERT_EQ(record.channels.size(), channels) << text.substr(0, 300);
  ASSERT_EQ(record.size(), rows) << text.substr(0, 300);
  EXPECT_NEAR(1.0 / record.interval(), rate, 1e-3 * rate) << text.substr(0, 300);
  EXPECT_EQ(record.channels[0].quantity, quantity);
  for (int k = 0; k < rows; k += 17)
    EXPECT_NEAR(record.samples(0, k), factor * decay(k), 2e-4 * factor) << text.substr(0, 300);
}

std::string clock(int k) {
  return fmt::format("10:00:{:02d},{:02d}0", k / 100, k % 100);
}

// Oracle beside the decay: the unit behind the numbers, and the words of the gyroscope.
TEST(PatternedText, HasTheSameWordsInEveryRow) {
  using Row = std::function<std::string(int, double)>;
  const std::pair<Row, std::pair<std::size_t, double>> texts[] = {
      {[](int k, double a) {
         return fmt::format("t={:.2f} Acceleration X: {:.5f}, Y: {:.5f}, Z: {:.5f} g", 0.01 * k, a, -a,
                            1 + 0.1 * a);
       },
       {3, g}},
      {[](int k, double a) {
         return fmt::format("2026-11-26 {} - imu[812] - INFO - ax={:.5f} ay={:.5f}", clock(k), a, -a);
       },
       {2, 1.0}},
      {[](int k, double a) { return fmt::format("2026-11-26 {} INFO {:.5f} {:.5f}", clock(k), a, -a); },
       {2, 1.0}},
      {[](int k, double a) {
         return fmt::format("[2026-11-26 {}] [INFO] accel: {:.5f}, {:.5f}", clock(k), a, -a);
       },
       {2, 1.0}},
      {[](int k, double a) { return fmt::format("({:.2f}, {:.5f}, {:.5f})", 0.01 * k, a, -a); }, {2, 1.0}},
      {[](int k, double a) { return fmt::format("{{'t': {:.2f}, 'ax': {:.5f}}}", 0.01 * k, a); }, {1, 1.0}},
      {[](int k, double a) {
         return fmt::format("t= {:.2f} Linear:\tx= {:.5f} |\ty= {:.5f}", 0.01 * k, a, -a);
       },
       {2, 1.0}},
      {[](int k, double a) {
         return fmt::format("t: {:.2f} Accel X: {:.5f} Y: {:.5f} Gyro X: {:.5f}", 0.01 * k, a, -a, 0.5 * a);
       },
       {2, 1.0}},
      {[](int k, double a) { return fmt::format("$PIMU,{:.2f},{:.5f},{:.5f}*3C", 0.01 * k, a, -a); },
       {2, 1.0}},
      {[](int k, double a) { return fmt::format("t={:.2f}s ax={:.3f}mg", 0.01 * k, 1e3 * a); }, {1, g}},
      {[](int k, double a) { return fmt::format("{:11.5E}{:12.5E}", 0.01 * k, a - 2.0); }, {1, 0.0}}};
  for (const auto& [row, expected] : texts) {
    const std::string text = signal_rows(rows, row);
    if (expected.second > 0.0)
      expect_decay(text, expected.first, expected.second);
    else
      EXPECT_NEAR(recognised(text).samples(0, 20), decay(20) - 2.0, 1e-4);
  }
}

TEST(PatternedText, IsNoneWhereACommaMayBeDecimal) {
  const auto with_commas = [](const char* form) {
    return signal_rows(rows, [&](int k, double a) {
      std::string row = fmt::format(fmt::runtime(form), 0.01 * k, a);
      std::ranges::replace(row, '.', ',');
      return row;
    });
  };
  EXPECT_THAT(question_of(with_commas("({:.2f},{:.3f})")), testing::Not(testing::StartsWith("read at")));
  EXPECT_THAT(question_of(with_commas("({:.2f}; {:.3f})")), testing::Not(testing::StartsWith("read at")));
  EXPECT_THAT(question_of(with_commas("{:.2f},{:.3f}")), HasSubstr("decimal commas between commas"));
}

// Oracle beside the decay: the second sensor moves half as far.
TEST(RowsOfSensors, AreChannelsSideBySideOrAQuestion) {
  const auto text = [](const char* head, const std::function<std::string(int, int, double)>& row) {
    std::string rows_of_all = head;
    for (int k = 0; k < rows; ++k)
      for (int sensor = 1; sensor <= 2; ++sensor) rows_of_all += row(sensor, k, decay(k) / sensor) + "\n";
    return rows_of_all;
  };
  expect_decay(text("sensor,time [s],acceleration [g]\n",
                    [](int s, int k, double a) { return fmt::format("S{},{:.2f},{:.5f}", s, 0.01 * k, a); }),
               2, g);
  expect_decay(text("node_id;t [ms];acc [m/s2]\n",
                    [](int s, int k, double a) { return fmt::format("{};{};{:.5f}", s, 10 * k, a); }),
               2, 1.0);
  expect_decay(
      text("", [](int s, int k, double a) { return fmt::format("acc{} t={:.2f} a={:.5f}", s, 0.01 * k, a); }),
      2, 1.0);
  std::string blocks = "sensor,time [s],acceleration [g]\n";
  for (const char sensor : {'A', 'B'})
    blocks += signal_rows(
        rows, [&](int k, double a) { return fmt::format("{},{:.2f},{:.5f}", sensor, 0.01 * k, a); });
  expect_decay(blocks, 2, g);
  EXPECT_THAT(question_of(text("sensor,time [s],acceleration [g]\n",
                               [](int s, int k, double a) {
                                 return fmt::format("S{},{:.3f},{:.5f}", s, 0.01 * k + 0.002 * s, a);
                               })),
              HasSubstr("rows of 2 sensors, 'S1', 'S2', each with times of its own"));
  expect_decay("time [s],state,acc [m/s2]\n" + signal_rows(rows,
                                                           [](int k, double a) {
                                                             return fmt::format("{:.2f},{},{:.5f}", 0.01 * k,
                                                                                k < 190 ? "run" : "walk", a);
                                                           }),
               1, 1.0);  // states, no sensors
}

TEST(PartsOfSeconds, BehindAColonAreCountedToWhereTheyBeginAgain) {
  const auto text = [](int per_second, int step, const char* form) {
    return "Time;Displacement (mm)\n" + signal_rows(rows, [&](int k, double a) {
             return fmt::format("{};{:.5f}",
                                fmt::format(fmt::runtime(form), k / per_second, step * (k % per_second)), a);
           });
  };
  const auto expect = [](const std::string& one, double rate) {
    expect_decay(one, 1, 1e-3, rate, Quantity::displacement);
  };
  expect(text(100, 1, "10:00:{:02d}:{:02d}"), 100.0);  // hundredths
  expect(text(50, 2, "10:00:{:02d}:{:02d}"), 50.0);
  expect(text(25, 1, "9:00:{:02d}:{:02d}"), 25.0);  // frames
  expect(text(100, 10, "10:00:{:02d}:{}"), 100.0);  // thousandths
  expect(text(100, 10, "10:00:{:02d}:{:03d}"), 100.0);
  EXPECT_THAT(question_of(text(4, 7, "10:00:{:02d}:{:02d}")), HasSubstr("--rate HZ"));
}

TEST(RestartingClocks, GoOnWhereTheyBeginAgain) {
  expect_decay("ms;ax\n" + signal_rows(rows,
                                       [](int k, double a) {
                                         return fmt::format("{};{:.5f}", (64000 + 10 * k) % 65536, a);
                                       }),
               1, 1.0);
  expect_decay("second;ax\n" + signal_rows(rows,
                                           [](int k, double a) {
                                             return fmt::format("{:.2f};{:.5f}",
                                                                std::fmod(58.0 + 0.01 * k, 60.0), a);
                                           }),
               1, 1.0);
  expect_decay("time;ax\n" + signal_rows(rows,
                                         [](int k, double a) {
                                           const int second = 58 + k / 100;
                                           return fmt::format("10{:02d}{:02d}.{:02d};{:.5f}", second / 60,
                                                              second % 60, k % 100, a);
                                         }),
               1, 1.0);
}

TEST(Words, NameQuantitiesInFurtherLanguages) {
  const std::pair<const char*, Quantity> names[] = {
      {"Tijd;Verplaatsing", Quantity::displacement},    {"Tijd;Snelheid", Quantity::velocity},
      {"Czas;Przemieszczenie", Quantity::displacement}, {"Czas;Prędkość", Quantity::velocity},
      {"Zaman;İvme", Quantity::acceleration},           {"Zaman;Hız", Quantity::velocity},
      {"Zaman;Yer değiştirme", Quantity::displacement}, {"Tid;Hastighet", Quantity::velocity},
      {"Tid;Förskjutning", Quantity::displacement}};
  for (const auto& [name, quantity] : names)
    expect_decay(
        std::string(name) + "\n" +
            signal_rows(rows, [](int k, double a) { return fmt::format("{:.2f};{:.5f}", 0.01 * k, a); }),
        1, 1.0, 100.0, quantity);
}

TEST(Units, StandInSignsOfLatexAndOfMathematics) {
  const std::pair<const char*, double> names[] = {{"acc [$mm/s^{2}$]", 1e-3},
                                                  {"acc [m⋅s⁻²]", 1.0},
                                                  {"acc [g0]", g},
                                                  {"acc (g pk)", g},
                                                  {"acc [gravity]", g}};
  for (const auto& [name, factor] : names)
    expect_decay(
        fmt::format("time [s];{}\n", name) +
            signal_rows(rows, [](int k, double a) { return fmt::format("{:.2f};{:.5f}", 0.01 * k, a); }),
        1, factor);
}

TEST(Oscilloscope, HasStartAndIncrementBesideItsUnits) {
  expect_decay(
      "X,CH1,CH2,Start,Increment,\nSequence,Volt,Volt,0.0e+00,1.0e-02\n" +
          signal_rows(rows, [](int k, double a) { return fmt::format("{},{:.5f},{:.5f},,", k, a, -a); }),
      2, 1.0);
}

TEST(Tables, OfProgramsHaveRulesAndCountsAroundThem) {
  expect_decay(
      "| time [s] | acc [g] |\n|---------:|--------:|\n" +
          signal_rows(rows, [](int k, double a) { return fmt::format("| {:.2f} | {:.5f} |", 0.01 * k, a); }),
      1, g);
  expect_decay(
      "      time      acc\n" +
          signal_rows(rows,
                      [](int k, double a) { return fmt::format("{:<5d} {:.2f} {:.5f}", k, 0.01 * k, a); }) +
          "\n[400 rows x 2 columns]\n",
      1, 1.0);
}

}  // namespace
}  // namespace beamid::experiments::patterned_text_test
