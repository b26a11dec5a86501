// beamid track, on a measured record that lies outside the project and on the tutorial's own.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::track_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// Oracle: frequencies by a damped-sine fit to each plateau, made outside this project (the data's README).
TEST(Track, FindsEveryPlateauOfTheMovingSupport) {
  const fs::path record = source("../shared/data/dropbear-moving-support/slow_10_steps_test0.txt");
  if (!fs::exists(record)) GTEST_SKIP() << "the measured records are not here";
  Workplace place;
  const Outcome outcome =
      place.run("track '" + record.string() +
                "' --skip-malformed --time 4 --column 1 --quantity acceleration --unit m/s2 --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json plateaus = json::parse(outcome.out).at("plateaus");
  const struct {
    double time, frequency_hz;
  } expected[] = {{1.6, 28.23}, {2.6, 30.82}, {3.7, 33.88}, {4.9, 37.54},  {6.3, 41.96},
                  {7.2, 37.54}, {8.5, 33.88}, {9.6, 30.82}, {10.8, 28.23}, {12.5, 26.25}};
  for (const auto& [time, frequency] : expected) {
    double found = std::nan("");
    for (const json& plateau : plateaus) {
      const double from = plateau.at("window_s")[0], to = plateau.at("window_s")[1];
      if (from < time && time < to) found = plateau.at("frequency_hz").at("estimate");
    }
    EXPECT_NEAR(found, frequency, 0.005 * frequency) << "at " << time << " s";
  }
}

TEST(Track, WritesTableHistoryAndFigure) {
  Workplace place;
  const std::string record = source("docs/tutorials/02_identify_a_record/tip_acceleration.csv").string();
  const Outcome outcome = place.run("track '" + record + "' --band 2 8 --walk 0.01 --out results");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("Plateaus"));
  for (const char* file : {"results.json", "plateaus.csv", "history.csv", "tracking.png", "report.html"})
    EXPECT_TRUE(fs::exists(place.folder() / "results" / file)) << file;
}

TEST(Track, RefusesBadWords) {
  Workplace place;
  for (const char* words : {"track", "track x.csv --band 5 2", "track x.csv --walk -1",
                            "track x.csv --false-alarms 1", "track x.csv --shortest 1"})
    EXPECT_EQ(place.run(words).code, 2) << words;
}

}  // namespace
}  // namespace beamid::apps::track_test
