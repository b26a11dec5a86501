// The mesh moves by `pade`, whose steps make fast modes slower. Oracle: the beam that was simulated; the
// scheme's closed form, (w dt)^4 / 360 of the stiffness to leading order.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/identify/engine/comparison.hpp"

namespace beamid::experiments::step_error_test {
namespace {

const Progress silent = [](const std::string&) {};

Experiment driven(double rate_hz) {
  Experiment e = read_experiment(TomlTable::parse(
      "[beam]\nlength_m = 1.1\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = 2.12e11\nmass_kg = "
      "3.055\n"
      "tip_mass_kg = 0.36049\nelements = 40\n[damping]\nratio = 0.005\n"
      "[excitation]\nkind = \"random\"\nposition_m = 0.55\namplitude_n = 5\nfrequency_hz = 100\n"
      "[simulation]\nduration_s = 2\nseed = 3\nsampling_rate_hz = " +
          std::to_string(rate_hz) +
          "\n[[sensors]]\nnoise_m_per_s2 = 0.1\n[model]\nname = \"beam\"\n"
          "[[parameters]]\nquantity = \"bending_stiffness\"\nrelative_deviation = 0.1\n"
          "[[parameters]]\nquantity = \"damping_ratio\"\n",
      "driven.toml"));
  e.filters = {e.filter};
  e.discretisations = {e.discretisation};
  return e;
}

TEST(StepError, IsSaidOfTheMeshAndNotOfItsModes) {
  Experiment experiment = driven(500);
  experiment.reductions = {parse_reduction("none", "test"),
                           parse_reduction("modal_truncation:modes=8", "test")};
  const Comparison found = compare(experiment, simulated_record(experiment, {}, silent), {}, silent);
  const auto said =
      testing::Contains(testing::StartsWith("WRONG BY THE STEP: at 2 ms pade makes the stiffness"));
  ASSERT_EQ(found.runs[0].discretisation, "pade");
  EXPECT_THAT(texts(found.runs[0].objections), said);
  EXPECT_THAT(texts(found.runs[1].objections), testing::Not(said));
}

constexpr const char* falling_chain = R"toml(
[chain]
masses_kg = [1000, 800, 900]
stiffnesses_n_per_m = [2.0e6, 1.5e6, 1.2e6]
dashpots_n_s_per_m = [2055, 1541, 1233]
heights_m = [3, 3, 3]
[excitation]
kind = "release"
position_m = 9
deflection_m = 0.01
[simulation]
duration_s = 10
sampling_rate_hz = 500
seed = 3
[[sensors]]
quantity = "displacement"
position_m = 3
noise_m = 1e-6
[[sensors]]
quantity = "displacement"
position_m = 6
noise_m = 1e-6
[[sensors]]
quantity = "displacement"
position_m = 9
noise_m = 1e-6
[model]
name = "beam"
[[parameters]]
quantity = "storey_stiffness"
relative_deviation = 0.1
[[parameters]]
quantity = "storey_damping"
relative_deviation = 1.0
)toml";

// Oracle: 1 % in the first mode at 3.097 Hz, to which forward Euler adds w dt / 2 = 1.95 %.
TEST(StepError, IsSaidOfTheDampingOfEveryLinearModel) {
  Experiment experiment = read_experiment(TomlTable::parse(falling_chain, "falling.toml"));
  experiment.filters = {experiment.filter};
  experiment.reductions = {parse_reduction("modal_truncation:modes=3", "test")};
  experiment.discretisations = {"exponential", "forward_euler"};
  const Comparison found = compare(experiment, simulated_record(experiment, {}, silent), {}, silent);
  const auto said = testing::Contains(
      testing::HasSubstr("WRONG BY THE STEP: at 2 ms forward_euler has a damping ratio of"));
  EXPECT_THAT(texts(found.runs[0].objections), testing::Not(said));
  EXPECT_THAT(texts(found.runs[1].objections), said);
}

}  // namespace
}  // namespace beamid::experiments::step_error_test
