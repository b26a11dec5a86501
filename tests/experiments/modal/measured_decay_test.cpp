// Free decays of real cantilevers; oracle, unless said otherwise: the independent fits in the data's README.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/modal/classic_estimators.hpp"
#include "experiments/modal/dominant_mode.hpp"

namespace beamid::experiments::measured_decay_test {
namespace {

constexpr double sampling_interval = 31.0 / 51200.0;

struct MeasuredWindow {
  const char* file;
  double from, to;  // s
  double frequency_hz, damping_ratio;
};

std::filesystem::path records() {
  return BEAMID_SOURCE_DIR "/../shared/data";
}

/// One column (from 0) of the rows that begin with as many numbers, within the window [s].
Eigen::VectorXd column(const std::filesystem::path& path, int number, double from, double to) {
  std::ifstream file(path);
  std::vector<double> samples;
  for (std::string line; std::getline(file, line);) {
    std::istringstream row(line);
    double value = 0;
    int read = 0;
    while (read <= number && row >> value) ++read;
    if (read > number) samples.push_back(value);
  }
  const auto begin = static_cast<Eigen::Index>(std::lround(from / sampling_interval));
  const auto end = static_cast<Eigen::Index>(std::lround(to / sampling_interval));
  return Eigen::Map<const Eigen::VectorXd>(samples.data(), static_cast<Eigen::Index>(samples.size()))
      .segment(begin, end - begin);
}

class MeasuredDecay : public testing::TestWithParam<MeasuredWindow> {};

TEST_P(MeasuredDecay, HasTheFrequencyAndDampingOfTheIndependentFit) {
  const std::filesystem::path folder = records() / "unb-tip-mass";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no measured records in " << folder;
  const MeasuredWindow& window = GetParam();
  const Eigen::VectorXd signal = column(folder / window.file, 2, window.from, window.to);
  const ModalEstimate estimate = dominant_mode(signal, sampling_interval);
  RecordProperty("frequency_hz", std::to_string(estimate.frequency_hz));
  RecordProperty("damping_ratio", std::to_string(estimate.damping_ratio));
  EXPECT_NEAR(estimate.frequency_hz / window.frequency_hz, 1, 0.002);
  EXPECT_NEAR(estimate.damping_ratio / window.damping_ratio, 1, 0.1);
  EXPECT_NEAR(estimate.realised_frequency_hz / window.frequency_hz, 1, 0.002);
  EXPECT_NEAR(estimate.realised_damping_ratio / window.damping_ratio, 1, 0.1);
  const DecrementEstimate check = logarithmic_decrement(signal, sampling_interval);
  EXPECT_NEAR(check.frequency_hz / window.frequency_hz, 1, 0.005);
  EXPECT_NEAR(check.damping_ratio / window.damping_ratio, 1, 0.15);
}

INSTANTIATE_TEST_SUITE_P(UnbTipMass, MeasuredDecay,
                         testing::Values(MeasuredWindow{"massa1_test1-1.txt", 0.308, 0.708, 11.166, 0.0145},
                                         MeasuredWindow{"massa1_test1-1.txt", 0.808, 1.608, 11.223, 0.0128},
                                         MeasuredWindow{"massa2_test1-2.txt", 0.808, 1.608, 14.40, 0.0139},
                                         MeasuredWindow{"massa3_test2-3.txt", 0.707, 1.307, 19.86, 0.0176}));

// The lightest tip mass rings in a second mode near 28 Hz, a third as strong, which one damped sine takes for
// damping (0.031 and 0.035). Oracle: two damped sines and an offset by scipy 1.10.1, optimize.least_squares,
// on the undecimated window, whose ends and 199 Hz mode the decimation leaves out.
TEST(MeasuredDecay, SeparatesTheTwoModesOfTheLightestTipMass) {
  const std::filesystem::path folder = records() / "unb-tip-mass";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no measured records in " << folder;
  const struct {
    const char* file;
    double frequency_hz, damping_ratio, companion_hz, companion_damping_ratio;
  } fits[] = {{"massa4_test2-4.txt", 22.69183, 0.0259403, 28.38235, 0.025672},
              {"massa4_test1-4.txt", 22.78437, 0.0272805, 28.30980, 0.019745}};
  for (const auto& fit : fits) {
    const ModalEstimate estimate =
        dominant_mode(column(folder / fit.file, 2, 0.608, 1.008), sampling_interval);
    EXPECT_NEAR(estimate.frequency_hz, fit.frequency_hz, 1e-3 * fit.frequency_hz);
    EXPECT_NEAR(estimate.damping_ratio, fit.damping_ratio, 0.02 * fit.damping_ratio);
    ASSERT_EQ(estimate.companions.size(), 1);
    EXPECT_NEAR(estimate.companions[0].frequency_hz, fit.companion_hz, 2e-3 * fit.companion_hz);
    EXPECT_NEAR(estimate.companions[0].damping_ratio, fit.companion_damping_ratio,
                0.05 * fit.companion_damping_ratio);
  }
}

// A cantilever without tip mass, whose second mode (41.4 Hz) starts twice as strong as the first.
TEST(MeasuredDecay, IsNotMisledByHigherModes) {
  const std::filesystem::path file = records() / "chowdhury-impulse" / "impulse.lvm";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no measured record " << file;
  ModalAnalysisSettings settings;
  settings.expected_frequency_hz = 6.6;
  const MeasuredWindow windows[] = {{"", 1.605, 4.105, 6.6175, 0.00286},
                                    {"", 4.105, 9.105, 6.6233, 0.0033},
                                    {"", 9.105, 15.105, 6.633, 0.0038}};
  for (const MeasuredWindow& window : windows) {
    const ModalEstimate estimate =
        dominant_mode(column(file, 1, window.from, window.to), sampling_interval, settings);
    EXPECT_NEAR(estimate.frequency_hz / window.frequency_hz, 1, 0.0002);
    EXPECT_NEAR(estimate.damping_ratio / window.damping_ratio, 1, 0.03);
  }
}

}  // namespace
}  // namespace beamid::experiments::measured_decay_test
