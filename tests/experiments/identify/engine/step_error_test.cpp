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
  EXPECT_THAT(found.runs[0].warnings, said);
  EXPECT_THAT(found.runs[1].warnings, testing::Not(said));
}

}  // namespace
}  // namespace beamid::experiments::step_error_test
