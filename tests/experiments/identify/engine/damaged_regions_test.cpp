// Oracles: the damaged beam that the record was simulated from, and the noise of its sensors.
#include <gtest/gtest.h>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/identify/engine/comparison.hpp"

namespace beamid::experiments::damaged_regions_test {
namespace {

const Progress silent = [](const std::string&) {};

const std::string beam =
    "[beam]\nlength_m = 1.1\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = 2.12e11\nmass_kg = 3.055\n"
    "tip_mass_kg = 0.36049\nelements = 20\n";

// A fifth of the stiffness lost in the second quarter, struck, heard in three places.
Experiment damaged() {
  return read_experiment(TomlTable::parse(
      beam + "[[beam.damages]]\nfrom_m = 0.275\nto_m = 0.55\nloss = 0.2\n[damping]\nratio = 0.005\n"
             "[excitation]\nkind = \"impulse\"\nposition_m = 0.4\nmomentum_n_s = 0.1\n"
             "[simulation]\nduration_s = 2\nsampling_rate_hz = 400\nseed = 3\n"
             "[[sensors]]\nnoise_m_per_s2 = 0.05\n[[sensors]]\nposition_m = 0.55\nnoise_m_per_s2 = 0.05\n"
             "[[sensors]]\nposition_m = 0.275\nnoise_m_per_s2 = 0.05\n",
      "damaged.toml"));
}

// The four quarters asked about, each described as whole, to 20 %.
Experiment assumed() {
  std::string text = beam + "[damping]\nratio = 0.005\n[model]\nname = \"beam\"\n";
  for (const char* part : {"from_m = 0\nto_m = 0.275", "from_m = 0.275\nto_m = 0.55",
                           "from_m = 0.55\nto_m = 0.825", "from_m = 0.825\nto_m = 1.1"})
    text += std::string("[[parameters]]\nquantity = \"bending_stiffness\"\n") + part +
            "\nrelative_deviation = 0.2\n";
  Experiment e = read_experiment(
      TomlTable::parse(text + "[[parameters]]\nquantity = \"damping_ratio\"\n", "described.toml"));
  e.reductions = {parse_reduction("modal_truncation:modes=10", "test")};
  e.filters = {e.filter};
  e.discretisations = {e.discretisation};
  return e;
}

TEST(DamagedRegion, IsFoundFromGuessesAFifthOff) {
  const Comparison found = compare(assumed(), simulated_record(damaged(), {}, silent), {}, silent);
  const ComparedRun& run = found.runs[0];
  ASSERT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
  for (const ComparedParameter& p : run.parameters)
    EXPECT_LT(std::abs(*p.error_percent()), 1.5) << p.estimate.name;
  EXPECT_LT(run.noise.maxCoeff(), 1.1 * 0.05);
}

// Exact modes follow the stiffness of the regions: held in the shapes of the whole beam, twelve of them
// converged 0.5 % and 9 standard deviations off.
TEST(DamagedRegion, IsFoundOnTwelveModesWithinTheirInterval) {
  Experiment asked = assumed();
  asked.reductions = {parse_reduction("modal_truncation:modes=12", "test")};
  asked.passes = 5;
  const Comparison found = compare(asked, simulated_record(damaged(), {}, silent), {}, silent);
  const ComparedRun& run = found.runs[0];
  ASSERT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
  for (const ComparedParameter& p : run.parameters) {
    const Estimate& e = p.estimate;
    EXPECT_LT(std::abs(e.value - *p.truth), 4.0 * e.deviation) << e.name;
    EXPECT_NEAR(e.deviation / *p.bound, 1.0, 0.05) << e.name;
  }
  EXPECT_LT(run.noise.maxCoeff(), 1.1 * 0.05);
}

// The mesh of the truth, in its own modes: nothing is left of the reduction's error.
TEST(DamagedRegion, IsFoundOnTheMeshItself) {
  Experiment asked = assumed();
  asked.reductions = {parse_reduction("none", "test")};
  asked.passes = 5;
  const Comparison found = compare(asked, simulated_record(damaged(), {}, silent), {}, silent);
  const ComparedRun& run = found.runs[0];
  ASSERT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
  for (const ComparedParameter& p : run.parameters) {
    const Estimate& e = p.estimate;
    EXPECT_LT(std::abs(e.value - *p.truth), 4.0 * e.deviation) << e.name;
    EXPECT_NEAR(e.deviation / *p.bound, 1.0, 0.05) << e.name;
  }
  EXPECT_LT(run.noise.maxCoeff(), 1.1 * 0.05);
}

TEST(ChosenChannels, AreKeptInTheirOrder) {
  const ComparedRecord all = simulated_record(damaged(), {}, silent);
  const ComparedRecord two = chosen_channels(all, {"x0.55m", "tip"});
  ASSERT_EQ(two.record.channels.size(), 2u);
  EXPECT_EQ(two.record.channels[0].name, "tip");
  EXPECT_EQ(two.record.samples.row(1), all.record.samples.row(1));
  EXPECT_EQ(two.sensor_noise.size(), 2);
}

TEST(ChosenChannels, RefuseNamesThatTheRecordDoesNotHave) {
  try {
    chosen_channels(simulated_record(damaged(), {}, silent), {"root"});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "no channel of motion named 'root'; the record has tip, x0.55m, x0.275m");
  }
}

}  // namespace
}  // namespace beamid::experiments::damaged_regions_test
