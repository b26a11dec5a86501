// The mesh moves by `pade`, whose steps make fast modes slower. Oracle: the beam that was simulated; the
// scheme's closed form, (w dt)^4 / 360 of the stiffness to leading order.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/record/read_record.hpp"
#include "tests/experiments/results/temporary_folder.hpp"

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

constexpr const char* two_masses = R"toml(
[system]
mass = "mass.mtx"
stiffness = "none.mtx"
labels = ["low", "high"]
[[system.parameters]]
name = "springs"
stiffness = "springs.mtx"
[[system.parameters]]
name = "dashpots"
damping = "dashpots.mtx"
[excitation]
kind = "release"
at = "high"
deflection_m = 0.01
[simulation]
duration_s = 8
sampling_rate_hz = 1000
seed = 3
[[sensors]]
at = "low"
noise_m_per_s2 = 0.001
[[sensors]]
at = "high"
noise_m_per_s2 = 0.001
[model]
name = "beam"
[reduction]
method = "none"
[[parameters]]
quantity = "factor"
name = "springs"
[[parameters]]
quantity = "factor"
name = "dashpots"
relative_deviation = 1
)toml";

// Dashpots of user-supplied matrices, in proportion to the springs. Oracle: forward Euler finds C + dt K
// (docs/theory/many_degrees_of_freedom.md), here 1 + dt 1000 / 0.6 times the dashpots.
TEST(StepError, IsSaidOfDashpotsInMatrices) {
  const TemporaryFolder here;
  const auto write = [&](const char* name, const char* entries) {
    std::ofstream(here.path / name) << "%%MatrixMarket matrix coordinate real symmetric\n2 2 " << entries;
  };
  write("mass.mtx", "2\n1 1 2\n2 2 1\n");
  write("none.mtx", "0\n");
  write("springs.mtx", "3\n1 1 3000\n2 1 -1000\n2 2 1000\n");
  write("dashpots.mtx", "3\n1 1 1.8\n2 1 -0.6\n2 2 0.6\n");
  std::ofstream(here.path / "two.toml") << two_masses;
  Experiment experiment = read_experiment(here.path / "two.toml");
  experiment.filters = {experiment.filter};
  experiment.reductions = {experiment.reduction};
  experiment.discretisations = {"exponential", "forward_euler"};
  const Comparison found =
      compare(experiment, simulated_record(experiment, here.path, silent), here.path, silent);
  const auto said = testing::Contains(
      testing::HasSubstr("WRONG BY THE STEP: at 1 ms forward_euler has a damping ratio of"));
  EXPECT_THAT(texts(found.runs[0].objections), testing::Not(said));
  EXPECT_THAT(texts(found.runs[1].objections), said);
  EXPECT_NEAR(found.runs[0].parameters.at(1).estimate.value, 1.0, 1e-3);
  EXPECT_NEAR(found.runs[1].parameters.at(1).estimate.value, 1.0 + 1e-3 * 1000 / 0.6, 0.02);
}

// A cubic spring, K = 500 N/m at rest, and the equivalent mass 1.0806 kg. Oracle: for w the midpoint rule
// finds tan(w dt / 2) 2 / dt, of which the stiffness is (w dt)^2 / 6 too large: 0.193 % at 3.424 Hz and 5 ms.
TEST(StepError, OfASpringThatIsNotLinearIsThatAtRest) {
  const std::filesystem::path folder = BEAMID_SOURCE_DIR "/docs/tutorials/11_nonlinear_oscillator";
  Experiment experiment = read_experiment(folder / "duffing.toml");
  experiment.filters = {experiment.filter};
  experiment.reductions = {experiment.reduction};
  experiment.discretisations = {"runge_kutta_4", "implicit_midpoint"};
  const Comparison found =
      compare(experiment, measured_record("duffing", read_record(folder / "duffing.csv")), folder, silent);
  EXPECT_THAT(texts(found.runs[0].objections),
              testing::Not(testing::Contains(testing::HasSubstr("WRONG BY THE STEP"))));
  EXPECT_THAT(texts(found.runs[1].objections),
              testing::Contains(testing::StartsWith("WRONG BY THE STEP: at 5 ms implicit_midpoint makes the "
                                                    "stiffness of the mode at 3.427 Hz 0.19 % too large")));
}

}  // namespace
}  // namespace beamid::experiments::step_error_test
