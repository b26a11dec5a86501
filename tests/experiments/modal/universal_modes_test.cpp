// Mode shapes in Universal Files. Oracles: the numbers written, and datasets typed by hand from the format's
// description [uff], columns counted.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>
#include <numbers>
#include <random>
#include <sstream>

#include "experiments/modal/universal_modes.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::universal_modes_test {
namespace {

using Complex = std::complex<double>;
using testing::HasSubstr, testing::StartsWith;

constexpr double six_digits = 1e-5;  // of E13.5

NodalModes three_nodes(bool complex) {
  NodalModes modes{"two modes of a strip", Eigen::Matrix3Xd::Zero(3, 3), {{0, 1}, {1, 2}}, {}, complex};
  modes.places.row(0) << 0.0, 0.4, 1.0;
  for (const double f : {3.4555187, 21.655}) {
    NodalModes::Mode mode{f, 0.01 * f, {}, {}, Eigen::Matrix3Xcd::Zero(3, 3)};
    mode.shape.row(2) << 0.0, Complex(0.35, complex ? 0.02 : 0.0), f > 10.0 ? -1.0 : 1.0;
    if (complex)
      mode.frequency_deviation_hz = 1.25e-3;
    else
      mode.modal_mass = 0.17;
    modes.modes.push_back(mode);
  }
  return modes;
}

NodalModes read(const std::string& text) {
  return read_universal_modes(TemporaryFile("modes.uff", text).path());
}

TEST(UniversalModes, AreReadAsTheyWereWritten) {
  for (const bool complex : {false, true}) {
    const NodalModes written = three_nodes(complex), found = read(universal_file(written));
    EXPECT_EQ(found.complex, complex);
    ASSERT_EQ(found.modes.size(), 2U);
    EXPECT_LT((found.places - written.places).norm(), six_digits);
    for (std::size_t m = 0; m < 2; ++m) {
      const NodalModes::Mode &mode = found.modes[m], &truth = written.modes[m];
      EXPECT_NEAR(mode.frequency_hz, truth.frequency_hz, six_digits * truth.frequency_hz);
      EXPECT_NEAR(mode.damping_ratio.value(), truth.damping_ratio.value(),
                  six_digits * truth.damping_ratio.value());
      EXPECT_LT((mode.shape - truth.shape).norm(), six_digits);
      EXPECT_EQ(mode.modal_mass.has_value(), !complex);  // modal A and B are not written
      EXPECT_EQ(mode.frequency_deviation_hz.value_or(0.0), truth.frequency_deviation_hz.value_or(0.0));
    }
  }
}

// Columns of records 6 to 10 of dataset 55, and of 15 and 82.
TEST(UniversalModes, StandInTheColumnsOfTheFormat) {
  std::istringstream text(universal_file(three_nodes(false)));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  const auto begin = std::find(lines.begin(), lines.end(), "    55");
  ASSERT_NE(begin, lines.end());
  EXPECT_EQ(begin[-1], "    -1");
  EXPECT_EQ(begin[6], "         1         2         2         8         2         3");
  EXPECT_EQ(begin[7], "         2         4         1         1");
  EXPECT_EQ(begin[8], "  3.45552E+00  1.70000E-01  3.45552E-02  0.00000E+00");
  EXPECT_EQ(begin[11], "         2");
  EXPECT_EQ(begin[12], "  0.00000E+00  0.00000E+00  3.50000E-01");
  EXPECT_EQ(begin[15], "    -1");
  const auto nodes = std::find(lines.begin(), lines.end(), "    15");
  EXPECT_EQ(nodes[2], "         2         0         0         8  4.00000E-01  0.00000E+00  0.00000E+00");
  const auto path = std::find(lines.begin(), lines.end(), "    82");
  EXPECT_EQ(path[1], "         1         3         8");
  EXPECT_EQ(path[3], "         1         2         3");
}

// As another program writes them: millimetres, six values at a node, accelerations with phases, labels that
// do not begin at 1, double precision, Fortran's D.
constexpr const char* of_another_program = R"(    -1
   164
         5mm (milli-newton)            2
  1.0000000000000000D+03  1.0000000000000000D+03  1.0000000000000000D+00
  2.7315000000000000D+02
    -1
    -1
  2411
       101         1         1        11
   0.0000000000000000D+00   0.0000000000000000D+00   0.0000000000000000D+00
       205         1         1        11
   1.2500000000000000D+03   0.0000000000000000D+00   5.0000000000000000D+02
    -1
    -1
    55
Shape of a plate
NONE
21-NOV-26
NONE
NONE
         1         3         3        12         6         6
         2         6         1         1
 -2.00000E+00  1.00000E+02  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00
)";

TEST(UniversalModes, ComeInOtherUnitsAndKinds) {
  std::string text(of_another_program);
  const Complex rate(-2.0, 100.0), moved = 0.5 * rate * rate;
  for (const int node : {101, 205}) {
    text += fmt::format("{:10}\n", node);
    const double scale = node == 205 ? 1.0 : 0.0;
    for (int k = 0; k < 12; ++k) {
      const double value = k == 4 ? scale * moved.real() : k == 5 ? scale * moved.imag() : 0.0;
      text += fmt::format("{:20.12E}{}", value, k % 4 == 3 ? "\n" : "");
    }
  }
  const NodalModes found = read(text + "    -1\n");
  ASSERT_EQ(found.modes.size(), 1U);
  EXPECT_NEAR(found.modes[0].frequency_hz, std::abs(rate) / (2.0 * std::numbers::pi), 1e-12);
  EXPECT_NEAR(found.modes[0].damping_ratio.value(), 2.0 / std::abs(rate), 1e-15);
  EXPECT_LT(std::abs(found.modes[0].shape(2, 1) - 0.5), 1e-4);  // frequency and ratio of lambda lose nothing
  EXPECT_NEAR(found.places(0, 1), 1.25, 1e-12);
  EXPECT_NEAR(found.places(2, 1), 0.5, 1e-12);
}

std::string refusal(const std::string& text) {
  const TemporaryFile file("modes.uff", text);
  return input_error_of(file, [&] { read_universal_modes(file.path()); });
}

TEST(UniversalModes, AreRefusedAtTheirPlace) {
  const std::string whole = universal_file(three_nodes(false));
  EXPECT_THAT(refusal("    -1\n   151\nx\n    -1\n"),
              HasSubstr("no mode among the datasets; expected datasets 55"));
  std::string word = whole;
  word.replace(word.find("  3.45552E+00"), 13, "  3.45552X+00");
  EXPECT_THAT(refusal(word),
              testing::ContainsRegex("modes.uff:[0-9]+:1: '3.45552X\\+00'; expected a number of the mode"));
  std::string shorter = whole;
  shorter.resize(shorter.find("    55") + 200);
  EXPECT_THAT(refusal(shorter), HasSubstr("the dataset ends; expected"));
  std::string negative = whole;
  negative.replace(negative.find("  3.45552E+00"), 13, " -3.45552E+00");
  EXPECT_THAT(refusal(negative), HasSubstr("a mode at -3.45552 Hz; expected a positive frequency"));
}

// Whatever bytes are changed, removed or cut off: modes or a message.
TEST(UniversalModes, SurviveDamage) {
  const std::string whole = universal_file(three_nodes(true));
  std::mt19937 random(55);
  for (int round = 0; round < 400; ++round) {
    std::string damaged = whole;
    const std::size_t at = random() % damaged.size();
    if (round % 3 == 0)
      damaged.resize(at);
    else if (round % 3 == 1)
      damaged.erase(at, 1 + random() % 40);
    else
      damaged[at] = static_cast<char>(random() % 256);
    try {
      const NodalModes found = read(damaged);
      EXPECT_GT(found.modes.size(), 0U);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("expected"));
    }
  }
}

TEST(UniversalModes, AreDistinguishedFromRecords) {
  const TemporaryFile modes("modes.uff", universal_file(three_nodes(false))),
      record("record.uff", "    -1\n    58\n    -1\n"), text("a.csv", "t,a\n-1,55\n");
  EXPECT_TRUE(holds_universal_modes(modes.path()));
  EXPECT_FALSE(holds_universal_modes(record.path()));
  EXPECT_FALSE(holds_universal_modes(text.path()));
  EXPECT_FALSE(holds_universal_modes("nowhere.uff"));
}

}  // namespace
}  // namespace beamid::experiments::universal_modes_test
