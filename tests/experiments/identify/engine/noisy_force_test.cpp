// A measured force whose noise is stated beside a motion whose noise is not, or is stated by nobody.
// Oracle: the oscillator whose struck motion was worked out in closed form.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "tests/experiments/modal/struck_modes.hpp"

namespace beamid::experiments::noisy_force_test {
namespace {

const test::StruckMode truth{3.4555, 0.0045, 1.0806};

// Struck once, with noise of the force.
ComparedRun identified(double force_n, const std::string& stated, std::uint64_t seed) {
  Record clean = test::struck_modes({truth}, {{1.0, 0.02, 50.0}}, 4e-3, 4000);
  for (Channel& channel : clean.channels) channel.position = 1.1;
  const Experiment experiment = read_experiment(TomlTable::parse(
      "[beam]\nlength_m = 1.1\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = 2.12e11\nmass_kg = "
      "3.055\n"
      "tip_mass_kg = 0.36049\n[filter]\nmethod = \"ekf\"\n[[parameters]]\nquantity = \"stiffness\"\n"
      "[[parameters]]\nquantity = \"damping\"\n[[parameters]]\nquantity = \"mass\"\n" +
          stated,
      "struck.toml"));
  const Record record = test::with_noise(clean, force_n, 0.05, seed);
  return identify_with_model(experiment, measured_record("struck", record), {}, [](const std::string&) {})
      .runs.at(0);
}

// With the answer to the force's noise counted as noise of the accelerometer, too, 1 % of the hammer's peak
// made the stiffness 10 % too large, nine deviations.
TEST(NoisyForce, CountsOnceInTheMotionThatItLeaves) {
  const double stiffness = truth.mass * std::pow(2.0 * std::numbers::pi * truth.frequency_hz, 2);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const ComparedRun run = identified(0.5, "[noise]\nforce_n = 0.5\n", seed);
    ASSERT_TRUE(run.has_estimate()) << run.reason;
    const Estimate& found = run.parameters.at(0).estimate;
    EXPECT_LT(std::abs(found.value - stiffness), 4.0 * found.deviation) << seed;
    EXPECT_NEAR(found.value, stiffness, 0.04 * stiffness) << seed;
  }
}

TEST(NoisyForce, ThatNobodyStatedIsReportedWhereItMovesAnAnswer) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const ComparedRun run = identified(0.5, "", seed);
    EXPECT_EQ(run.status, ComparedRun::Status::contradicted) << seed;
    ASSERT_TRUE(run.likeliest_input_noise) << seed;
    EXPECT_NEAR(run.likeliest_input_noise->deviation[0], 0.5, 0.25) << seed;
    EXPECT_THAT(texts(run.objections),
                testing::Contains(testing::AllOf(testing::HasSubstr(" N of noise in "),
                                                 testing::HasSubstr("State it: [noise] force_n = 0."))))
        << seed;
    const ComparedRun exact = identified(0.0, "", seed);
    EXPECT_EQ(exact.status, ComparedRun::Status::converged) << exact.reason;
    EXPECT_THAT(texts(exact.objections), testing::Each(testing::Not(testing::HasSubstr("of noise in"))))
        << seed;
  }
}

}  // namespace
}  // namespace beamid::experiments::noisy_force_test
