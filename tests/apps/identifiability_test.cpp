// Oracle: what is printed, written and refused; the numbers have their own tests.
#include <gmock/gmock.h>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::identifiability_test {
namespace {

using nlohmann::json, testing::HasSubstr;

constexpr const char* quick = " --elements 10 --duration 2 --sampling-rate 200 ";

TEST(IdentifiabilityCommand, NeedsNoFile) {
  const Outcome outcome = Workplace().run(std::string("identifiability --json") + quick);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_EQ(found["command"], "identifiability");
  EXPECT_EQ(found["model"], "beam");
  EXPECT_EQ(found["reduction"], "modal_truncation:modes=3");
  const json& stiffness = found["parameters"]["bending_stiffness"];
  EXPECT_NEAR(stiffness["value"].get<double>(), 228.96, 1e-9);
  EXPECT_GT(stiffness["bound"].get<double>(), 0.0);
  EXPECT_LE(stiffness["conditional_bound"].get<double>(), stiffness["bound"].get<double>());
  EXPECT_EQ(found["correlations"].size(), found["parameters"].size());
}

TEST(IdentifiabilityCommand, PrintsAtMostAHundredColumnsAndWritesItsFiles) {
  const Workplace place;
  const Outcome outcome = place.run(std::string("identifiability --model modal --out found") + quick);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  std::istringstream lines(outcome.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 104u) << line;
  for (const char* file :
       {"results.json", "parameters.csv", "combinations.csv", "correlations.csv", "record_lengths.csv",
        "sampling_rates.csv", "sensor_places.csv", "record.png", "sensors.svg"})
    EXPECT_TRUE(fs::exists(place.folder() / "found" / file)) << file;
}

TEST(IdentifiabilityCommand, AsksOneDegreeOfFreedomByRayleighUnlessTold) {
  const Outcome outcome = Workplace().run(std::string("identifiability --json --model sdof") + quick);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_EQ(found["reduction"], "rayleigh");
  EXPECT_FALSE(found.contains("sensor_place"));
}

TEST(IdentifiabilityCommand, RefusesWhatItDoesNotKnow) {
  const Workplace place;
  const Outcome model = place.run("identifiability --model sdf");
  EXPECT_EQ(model.code, 2);
  EXPECT_THAT(model.err, HasSubstr("--model: unknown model 'sdf'; did you mean 'sdof'? known: "));
  const Outcome reduction = place.run("identifiability --reduction modal");
  EXPECT_EQ(reduction.code, 2);
  EXPECT_THAT(reduction.err, HasSubstr("--reduction: unknown reduction 'modal'"));
  place.write("bad.toml",
              "[beam]\nlength_m = 1\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = 2e11\n"
              "density_kg_per_m3 = 7800\n[identifiability]\nplaces = 0\n");
  const Outcome places = place.run("identifiability --config bad.toml");
  EXPECT_EQ(places.code, 2);
  EXPECT_THAT(places.err, HasSubstr("bad.toml:8:10: identifiability.places is 0; expected a whole number"));
}

TEST(IdentifiabilityCommand, SaysWhenAForceThatIsNotMeasuredNeverEnds) {
  const Workplace place;
  place.write("step.toml",
              "[beam]\nlength_m = 1\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = 2e11\n"
              "density_kg_per_m3 = 7800\n[excitation]\nkind = \"static\"\nforce_n = 1\n"
              "[identifiability]\nforce_measured = false\n");
  const Outcome outcome = place.run("identifiability --config step.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("step.toml:7:1: the force acts until the record ends"));
}

}  // namespace
}  // namespace beamid::apps::identifiability_test
