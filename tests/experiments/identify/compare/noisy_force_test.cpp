// A measured force whose noise is stated beside a motion whose noise is not.
// Oracle: the oscillator whose struck motion was worked out in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/compare/comparison.hpp"
#include "tests/experiments/modal/struck_modes.hpp"

namespace beamid::experiments::noisy_force_test {
namespace {

// With the answer to the force's noise counted as noise of the accelerometer, too, 1 % of the hammer's peak
// made the stiffness 10 % too large, nine deviations.
TEST(NoisyForce, CountsOnceInTheMotionThatItLeaves) {
  const test::StruckMode truth{3.4555, 0.0045, 1.0806};
  const double stiffness = truth.mass * std::pow(2.0 * std::numbers::pi * truth.frequency_hz, 2);
  Record clean = test::struck_modes({truth}, {{1.0, 0.02, 50.0}}, 4e-3, 4000);
  for (Channel& channel : clean.channels) channel.position = 1.1;
  const Experiment experiment = read_experiment(TomlTable::parse(
      "[beam]\nlength_m = 1.1\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = 2.12e11\nmass_kg = "
      "3.055\n"
      "tip_mass_kg = 0.36049\n[filter]\nmethod = \"ekf\"\n[[parameters]]\nquantity = \"stiffness\"\n"
      "[[parameters]]\nquantity = \"damping\"\n[[parameters]]\nquantity = \"mass\"\n[noise]\nforce_n = 0.5\n",
      "struck.toml"));
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Record record = test::with_noise(clean, 0.5, 0.05, seed);
    const Comparison compared =
        identify_with_model(experiment, measured_record("struck", record), {}, [](const std::string&) {});
    const ComparedRun& run = compared.runs.at(0);
    ASSERT_TRUE(run.has_estimate()) << run.reason;
    const Estimate& found = run.parameters.at(0).estimate;
    EXPECT_LT(std::abs(found.value - stiffness), 4.0 * found.deviation) << seed;
    EXPECT_NEAR(found.value, stiffness, 0.04 * stiffness) << seed;
  }
}

}  // namespace
}  // namespace beamid::experiments::noisy_force_test
