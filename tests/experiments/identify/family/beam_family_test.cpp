// Oracle: the strip that four beams were simulated from.
#include "experiments/identify/family/beam_family.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "experiments/config/read_experiment.hpp"

namespace beamid::experiments::beam_family_test {
namespace {

const Progress silent = [](const std::string&) {};

// Steel, 30 mm x 2 mm, an accelerometer at the tip; only the first mode is below half the sampling rate.
Experiment strip(double length, double modulus, double sensor, int seed) {
  return read_experiment(TomlTable::parse(
      fmt::format("[beam]\nlength_m = {}\nwidth_m = 0.03\nheight_m = 0.002\nyoungs_modulus_pa = {}\n"
                  "density_kg_per_m3 = 7850\ntip_mass_kg = {}\nelements = 10\n[damping]\nratio = {}\n"
                  "[[sensors]]\nquantity = \"acceleration\"\nnoise_m_per_s2 = 0.02\n"
                  "[simulation]\nduration_s = 4\nsampling_rate_hz = 50\nseed = {}\n"
                  "[model]\nname = \"beam\"\n[reduction]\nmethod = \"modal_truncation\"\nmodes = 1\n"
                  "[[parameters]]\nquantity = \"bending_stiffness\"\nrelative_deviation = 0.2\n"
                  "[[parameters]]\nquantity = \"tip_mass\"\nname = \"sensor\"\nrelative_deviation = 1\n"
                  "[[parameters]]\nquantity = \"damping_ratio\"\nname = \"damping_{:.0f}cm\"\n",
                  length, modulus, sensor, 0.004 + 0.002 * length, seed, 100 * length),
      "strip.toml"));
}

std::vector<FamilyMember> four_lengths() {
  std::vector<FamilyMember> members;
  int seed = 0;
  for (const double length : {0.3, 0.4, 0.5, 0.6}) {
    const Record record = simulated_record(strip(length, 2.05e11, 0.03, ++seed), ".", silent).record;
    members.push_back({fmt::format("l{:.0f}.toml", 100 * length), strip(length, 2.2e11, 0.02, 1), ".",
                       fmt::format("r{:.0f}.csv", 100 * length), record});
  }
  return members;
}

TEST(BeamFamily, FindsOneStiffnessAndOneSensorOfFourLengths) {
  const BeamFamily family = identify_family(four_lengths(), silent);
  EXPECT_TRUE(family.settled);
  ASSERT_EQ(family.parameters.size(), 6u);
  EXPECT_EQ(family.shared_by[0], "l30.toml, l40.toml, l50.toml, l60.toml");
  EXPECT_EQ(family.shared_by[2], "l30.toml");
  const double truth[] = {2.05e11 * 0.03 * 8e-9 / 12.0, 0.03};
  for (const std::size_t j : {0u, 1u}) {
    const Estimate& e = family.parameters[j];
    EXPECT_LT(std::abs(e.value - truth[j]), 4.0 * e.deviation) << e.name;
    EXPECT_LT(e.deviation, 0.01 * truth[j]) << e.name;
    for (const Comparison& alone : family.alone)  // one frequency tells no two numbers apart
      EXPECT_GT(alone.runs[0].parameters[j].estimate.deviation, 10.0 * e.deviation) << e.name;
  }
  EXPECT_GT(family.estimate.probability, 1e-3);
}

TEST(BeamFamily, NamesWhatDoesNotFit) {
  std::vector<FamilyMember> members = four_lengths();
  members.resize(2);
  for (ParameterChoice& choice : members[1].experiment.parameters)
    choice.name = choice.name.empty() ? "other" : choice.name + "_other";
  EXPECT_THAT([&] { identify_family(members, silent); },
              testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("share no parameter")));
  members[1].experiment.parameters.clear();
  EXPECT_THAT(
      [&] { identify_family(members, silent); },
      testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("l40.toml has no [[parameters]]")));
}

}  // namespace
}  // namespace beamid::experiments::beam_family_test
