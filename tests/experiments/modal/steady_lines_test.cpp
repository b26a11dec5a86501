// Sines in random vibration. Oracle everywhere: the sine that was added, and the record without it.
#include "experiments/modal/steady_lines.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "experiments/modal/modal_method.hpp"
#include "experiments/modal/study/modal_study.hpp"
#include "tests/experiments/modal/shaken_chain.hpp"

namespace beamid::experiments::steady_lines_test {
namespace {

using Eigen::Index, Eigen::MatrixXd;
using testing::HasSubstr;

const test::ShakenChain chain;

// Of this amplitude over the root mean square of the first output.
void add_sine(double frequency_hz, double relative_amplitude, MatrixXd& outputs) {
  const double amplitude =
      relative_amplitude * std::sqrt(outputs.row(0).squaredNorm() / static_cast<double>(outputs.cols()));
  for (Index k = 0; k < outputs.cols(); ++k) {
    const double wave =
        amplitude *
        std::cos(2 * std::numbers::pi * frequency_hz * chain.interval * static_cast<double>(k) + 0.7);
    outputs(0, k) += wave;
    outputs(1, k) += 0.8 * wave;
  }
}

Record record_of(const MatrixXd& outputs) {
  Record record;
  record.time = Eigen::VectorXd::LinSpaced(outputs.cols(), 0.0,
                                           chain.interval * static_cast<double>(outputs.cols() - 1));
  record.samples = outputs;
  record.channels = {{Quantity::displacement, "a"}, {Quantity::displacement, "b"}};
  return record;
}

ModalStudySettings bayoma() {
  ModalStudySettings settings;
  settings.method = {"bayoma", {{"response", std::string("displacement")}}};
  return settings;
}

// By chance one of a thousand records has one.
TEST(SteadyLines, SeesNoneInRandomVibration) {
  int lines = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed)
    lines += static_cast<int>(steady_lines(chain.record(5000, seed), chain.interval).lines.size());
  EXPECT_EQ(lines, 0);
}

TEST(SteadyLines, TakesSinesOutAndLeavesTheRest) {
  const MatrixXd random = chain.record(10000, 5);
  MatrixXd outputs = random;
  add_sine(1.061, 1.5, outputs);
  add_sine(3.3, 0.5, outputs);
  const SteadyLines found = steady_lines(outputs, chain.interval);
  ASSERT_EQ(found.lines.size(), 2U);
  EXPECT_NEAR(found.lines[0].frequency_hz, 1.061, 1e-4);
  EXPECT_NEAR(found.lines[1].frequency_hz, 3.3, 1e-4);
  EXPECT_LT((found.rest - random).norm(), 0.05 * random.norm());
}

// A decay fits its beginning and its end alike, a line as well: they differ in amplitude.
TEST(SteadyLines, LeavesADecayAlone) {
  MatrixXd outputs = 0.02 * standard_normal(4000, 3, 1).transpose();
  for (Index k = 0; k < outputs.cols(); ++k) {
    const double t = chain.interval * static_cast<double>(k);
    outputs(0, k) += std::exp(-0.003 * t) * std::cos(6.0 * t);
  }
  EXPECT_TRUE(steady_lines(outputs, chain.interval).lines.empty());
}

// Beside the first mode of 1 Hz and 2 %. Before: 1.02 to 1.06 Hz with deviations of 0.003, and no word.
TEST(SteadyLines, DoNotDrawAModeToThemselves) {
  int held = 0, said = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    MatrixXd outputs = chain.record(8000, seed);
    add_sine(1.06, 1.5, outputs);
    const RecordModes found = find_modes("", record_of(outputs), false, bayoma());
    ASSERT_FALSE(found.modes.empty()) << seed;
    const Pole& first = found.modes[0].pole;
    held += std::abs(first.frequency_hz() - 1.0) < 1.96 * first.frequency_deviation_hz ? 1 : 0;
    for (const std::string& warning : texts(found.objections))
      said += warning.find("A line at 1.06 Hz") != std::string::npos ? 1 : 0;
  }
  EXPECT_GE(held, 16);  // binomial of 20 and 0.95: fewer with probability 0.003
  EXPECT_EQ(said, 20);
}

// A line too weak for the whole record's test is still too strong for the band of the mode.
TEST(SteadyLines, WeakOnesAreLeftOutOfTheBand) {
  int held = 0, said = 0;
  const auto method = modal_method_registry().make("bayoma", {{"response", std::string("displacement")}});
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    MatrixXd outputs = chain.record(8000, seed);
    add_sine(1.06, 0.5, outputs);
    const PoleSearch found = method->search(outputs, chain.interval, 0);
    ASSERT_FALSE(found.orders[0].poles.empty()) << seed;
    const Pole& first = found.orders[0].poles[0];
    held += std::abs(first.frequency_hz() - 1.0) < 1.96 * first.frequency_deviation_hz ? 1 : 0;
    for (const std::string& warning : texts(found.objections))
      said += warning.find("beside the mode at") != std::string::npos ? 1 : 0;
  }
  EXPECT_GE(held, 16);
  EXPECT_GE(said, 19);
}

TEST(SteadyLines, HealthyBandsKeepTheirFrequencies) {
  int said = 0;
  const auto method = modal_method_registry().make("bayoma", {{"response", std::string("displacement")}});
  for (std::uint64_t seed = 101; seed <= 140; ++seed)
    said += static_cast<int>(method->search(chain.record(8000, seed), chain.interval, 0).objections.size());
  EXPECT_EQ(said, 0);
}

// A machine alone, whose speed wanders a little, is no mode: nothing shakes at random within less than the
// record resolves.
TEST(SteadyLines, WhatIsNarrowerThanTheRecordResolvesIsNoMode) {
  MatrixXd outputs = 0.1 * standard_normal(8000, 3, 1).transpose();
  for (Index k = 0; k < outputs.cols(); ++k) {
    const double t = chain.interval * static_cast<double>(k);
    outputs(0, k) += std::cos(2 * std::numbers::pi * (1.2 * t) + 1.5 * std::sin(0.004 * t));
  }
  const auto method = modal_method_registry().make("bayoma", {});
  const PoleSearch found = method->search(outputs, chain.interval, 0);
  EXPECT_FALSE(found.refused.empty());
  for (const Pole& pole : found.orders[0].poles) EXPECT_GT(std::abs(pole.frequency_hz() - 1.2), 0.05);
}

}  // namespace
}  // namespace beamid::experiments::steady_lines_test
