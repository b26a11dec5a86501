// beamid efficiency, end to end: what a user gets.
#include <gmock/gmock.h>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::efficiency_test {
namespace {

using nlohmann::json, testing::HasSubstr, testing::StartsWith;

const std::string quick =
    "efficiency --filter ekf --filter ukf:alpha=0.5 --damping-ratio 0.1 --runs 200 --passes lengthening";

TEST(Efficiency, WritesTablesFigureAndResults) {
  Workplace place;
  const Outcome outcome = place.run(quick + " --out found");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* file : {"results.json", "efficiency.csv", "consistency.csv", "efficiency_plot.svg",
                           "efficiency_plot.png", "efficiency_plot.csv"})
    EXPECT_TRUE(fs::exists(place.folder() / "found" / file)) << file;
  EXPECT_THAT(contents(place.folder() / "found" / "efficiency.csv"),
              StartsWith("damping_ratio,filter,passes,stiffness_rms_over_bound,"));
  const json found = json::parse(contents(place.folder() / "found" / "results.json"));
  EXPECT_EQ(found["configuration"]["filters"], json({"ekf", "ukf:alpha=0.5"}));
  ASSERT_EQ(found["cases"].size(), 2u);
  // Oracle: the Cramer-Rao bound, with 3.3 standard errors of an rms of 200 runs and 5 % allowed.
  for (const json& one : found["cases"]) {
    EXPECT_NEAR(one["stiffness"]["rms_over_bound"].get<double>(), 1.0, 0.05 + 3.3 / 20.0);
    EXPECT_NEAR(one["damping"]["rms_over_bound"].get<double>(), 1.0, 0.05 + 3.3 / 20.0);
    EXPECT_EQ(one["lost"]["count"], 0);
  }
}

TEST(Efficiency, GivesTheSameBytesForTheSameSeed) {
  const std::string words = "efficiency --filter ekf --damping-ratio 0.1 --runs 10 --json";
  const Outcome first = Workplace().run(words);
  EXPECT_EQ(first.code, 0) << first.err;
  EXPECT_EQ(first.out, Workplace().run(words).out);
  EXPECT_NE(first.out, Workplace().run(words + " --seed 5").out);
}

// Oracle: 95 % of 30 records of each kind of noise; below 23 once in ten thousand times.
TEST(Efficiency, TellsHowOftenIntervalsHoldTheTruth) {
  const Outcome outcome = Workplace().run("efficiency --study coverage --runs 30 --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json found = json::parse(outcome.out);
  ASSERT_EQ(found["coverage"].size(), 3u);
  for (const json& one : found["coverage"])
    for (const char* parameter : {"frequency", "damping_ratio"})
      EXPECT_GE(one[parameter]["inside"].get<int>(), 23) << one["noise"] << ' ' << parameter;
}

// The files of one record are enough to repeat it: simulated again and identified with the beam alone.
TEST(Efficiency, HandsOverALaboratoryRecordToRepeat) {
  Workplace place;
  const Outcome outcome = place.run("efficiency --study records --only 0 --out record");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("Record 0 of seed 1: right"));
  ASSERT_EQ(place.run("simulate --config record/rig.toml --out again").code, 0);
  EXPECT_TRUE(contents(place.folder() / "again" / "record.csv") ==
              contents(place.folder() / "record" / "record.csv"));
  const Outcome identified = place.run("identify record/record.csv --config record/beam.toml --json");
  ASSERT_EQ(identified.code, 0) << identified.err;
  const json study = json::parse(contents(place.folder() / "record" / "results.json")),
             alone = json::parse(identified.out);
  EXPECT_EQ(study["frequency_hz"]["estimate"], alone["frequency_hz"]["estimate"]);
  EXPECT_EQ(study["damping_ratio"]["estimate"], alone["damping_ratio"]["estimate"]);
}

TEST(Efficiency, CountsCleanDecaysThatFail) {
  const Outcome outcome = Workplace().run("efficiency --study decays --runs 5 --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out)["failed"], 0);
}

TEST(Efficiency, NamesWhatItRefuses) {
  const std::pair<const char*, const char*> refused[] = {
      {"--runs 1", "--runs is 1; expected a whole number from 2 to 1000000"},
      {"--damping-ratio 1", "--damping-ratio is 1; expected a number above 0 and below 1"},
      {"--study all", "--study is 'all'; expected filters, coverage, decays or records"},
      {"--study records --noise 0.1", "--study records takes no --noise"},
      {"--study records --runs 5 --only 5", "--only is 5; expected a whole number from 0 to 4"},
      {"--only 3", "--only goes with --study records"},
      {"--study coverage --filter ekf", "--study coverage takes no --filter"},
      {"--study coverage --damping-ratio 0.2",
       "--damping-ratio is 0.2; expected 0.1 at most for --study coverage"},
      {"--passes twice", "--passes is 'twice'; expected lengthening, single or both"},
      {"--guess bad", "--guess is 'bad'; expected drawn or ends"},
      {"--noise 0", "--noise is 0; expected a number above 0 and at most 1"},
      {"--filter ufk", "--filter: unknown filter 'ufk'"},
      {"--filter kf", "filter 'kf' takes linear models only"}};
  for (const auto& [words, message] : refused) {
    const Outcome outcome = Workplace().run(std::string("efficiency ") + words);
    EXPECT_EQ(outcome.code, 2) << words;
    EXPECT_THAT(outcome.err, HasSubstr(message)) << words;
  }
}

}  // namespace
}  // namespace beamid::apps::efficiency_test
