// beamid inspect and beamid prepare, end to end, and the tutorial that leads from a file to its modes.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::inspect_and_prepare_test {
namespace {

using nlohmann::json, testing::HasSubstr, testing::StartsWith;

/// 4 s of a decay at 5 Hz, sampled at 100 Hz, clipped at 0.8 for the first second; one line is damaged.
std::string clipped_decay(const char* damaged) {
  std::ostringstream text;
  text << "time_s,acceleration_m_per_s2\n";
  for (int k = 0; k < 400; ++k) {
    const double t = 0.01 * k, a = std::exp(-0.3 * t) * std::cos(10 * std::numbers::pi * t + 0.1);
    if (k == 200 && *damaged) text << damaged << "\n";
    text << t << "," << (t < 1 ? std::min(a, 0.8) : a) << "\n";
  }
  return text.str();
}

constexpr const char* steps =
    "[beam]\nlength_m = 1\nwidth_m = 0.02\nheight_m = 0.005\nyoungs_modulus_pa = 210e9\nmass_kg = 0.8\n"
    "[record]\nfile = \"decay.csv\"\n[[record.prepare]]\n";

TEST(Inspect, TellsWhatIsWrongWithARecordAndDrawsIt) {
  Workplace place;
  place.write("decay.csv", clipped_decay(""));
  const Outcome outcome = place.run("inspect decay.csv --out found");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("sampled at 100 Hz"));
  EXPECT_THAT(outcome.out, HasSubstr("clipped at 0.8 m/s2"));
  for (const char* file : {"results.json", "channels.csv", "record.png", "report.html"})
    EXPECT_TRUE(fs::exists(place.folder() / "found" / file)) << file;
  const json found = json::parse(contents(place.folder() / "found" / "results.json"));
  EXPECT_EQ(found["samples"], 400);
  EXPECT_NEAR(found["channels"][0]["frequency_hz"].get<double>(), 5, 0.1);
  EXPECT_GT(found["channels"][0]["clipped"].size(), 1u);
}

// Read as a displacement, it would give numbers like any other.
TEST(Inspect, AndEveryCommandWarnsWhereAColumnIsStatedOtherwiseThanItIsNamed) {
  Workplace place;
  fs::copy(source("docs/tutorials/02_identify_a_record/tip_acceleration.csv"), place.folder());
  for (const char* const command : {"inspect", "modal", "track", "prepare --config steps.toml"}) {
    place.write("steps.toml",
                "[record]\nwindow_s = [2, 10]\ntime = { column = 1, unit = \"s\" }\n"
                "channels = [{ quantity = \"displacement\", column = 2, unit = \"m\" }]\n"
                "[[record.prepare]]\nstep = \"detrend\"\n[beam]\nlength_m = 1\n"
                "bending_stiffness_n_m2 = 1\nmass_kg = 1\n");
    const std::string words = std::string(command).starts_with("prepare")
                                  ? ""
                                  : " --time 1 --column 2 --quantity displacement --unit m --window 2 10";
    EXPECT_THAT(place.run(command + std::string(" tip_acceleration.csv") + words).out,
                testing::HasSubstr("named 'acceleration_tip_m_per_s2' and stated as"))
        << command;
  }
}

TEST(Inspect, CountsDamagedLinesWhichOtherCommandsRefuse) {
  Workplace place;
  place.write("decay.csv", clipped_decay("damaged"));
  const Outcome told = place.run("inspect decay.csv --json");
  ASSERT_EQ(told.code, 0) << told.err;
  EXPECT_EQ(json::parse(told.out)["skipped_lines"], json::array({202}));
  const Outcome refused = place.run("modal decay.csv");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.first_error_line(), StartsWith("decay.csv:202:"));
  EXPECT_EQ(place.run("modal decay.csv --skip-malformed").code, 0);
}

// It was refused for a rate that nobody had stated.
TEST(Inspect, TakesARecordWhoseSecondHalfIsFaster) {
  const Workplace place;
  std::string text = "time_s,acceleration_m_per_s2\n";
  double time = 0.0;
  for (int k = 0; k < 400; ++k, time += k < 210 ? 0.004 : 0.001)
    text += std::to_string(time) + "," + std::to_string(std::cos(20.0 * time)) + "\n";
  place.write("faster.csv", text);
  const Outcome outcome = place.run("inspect faster.csv");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("median interval 0.004 s"));
}

TEST(Inspect, RefusesWhatIsNoRecord) {
  Workplace place;
  place.write("words.csv", "nothing but words\n");
  for (const auto& [words, message] : std::vector<std::pair<std::string, std::string>>{
           {"inspect", "beamid: inspect: which RECORD?"},
           {"inspect gone.csv", "gone.csv: no such file; expected a record of numbers in columns"},
           {"inspect a.csv b.csv", "beamid: inspect: unexpected argument 'b.csv'"},
           {"inspect words.csv", "words.csv"}}) {
    const Outcome outcome = place.run(words);
    EXPECT_EQ(outcome.code, 2) << words;
    EXPECT_THAT(outcome.first_error_line(), StartsWith(message));
  }
}

// Oracle: the decay before the filter; a low-pass that has settled changes neither frequency nor damping.
TEST(Prepare, WritesWhatTheStepsLeaveAndTheirCost) {
  Workplace place;
  place.write("decay.csv", clipped_decay(""));
  place.write("steps.toml", std::string(steps) + "step = \"low_pass\"\ncorner_hz = 20\n");
  const Outcome outcome = place.run("prepare --config steps.toml --out found");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* file :
       {"results.json", "preparation.csv", "prepared.csv", "before_and_after.png", "report.html"})
    EXPECT_TRUE(fs::exists(place.folder() / "found" / file)) << file;
  const json cost = json::parse(contents(place.folder() / "found" / "results.json"))["preparation"];
  EXPECT_EQ(cost["steps"][0]["step"], "low_pass");
  EXPECT_NEAR(cost["steps"][0]["cost"]["change_settled"]["damping_ratio_percent"].get<double>(), 0, 0.01);
  EXPECT_EQ(place.run("modal found/prepared.csv --window 1 3.9").code, 0);
}

TEST(Prepare, RefusesAtThePlaceOfWhatIsWrong) {
  Workplace place;
  place.write("decay.csv", clipped_decay(""));
  place.write("none.toml", std::string(steps).substr(0, std::string(steps).find("[[record")));
  place.write("wrong.toml", std::string(steps) + "step = \"low_pas\"\n");
  place.write("corner.toml", std::string(steps) + "step = \"low_pass\"\ncorner_hz = 60\n");
  place.write("method.toml", std::string(steps) + "step = \"resample\"\nmethod = \"linear\"\n");
  for (const auto& [words, message] : std::vector<std::pair<std::string, std::string>>{
           {"prepare", "beamid: prepare: --config FILE is missing"},
           {"prepare --config none.toml",
            "none.toml: no step; expected at least one table [[record.prepare]]"},
           {"prepare --config wrong.toml", "wrong.toml:10:8: unknown "},
           {"prepare --config corner.toml", "corner.toml:10:8: step 'low_pass': "},
           {"prepare --config method.toml",
            "method.toml:11:1: method is 'linear'; expected band_limited or spline"}}) {
    const Outcome outcome = place.run(words);
    EXPECT_EQ(outcome.code, 2) << words;
    EXPECT_THAT(outcome.first_error_line(), StartsWith(message)) << words;
  }
}

// Oracle: the frequencies of the clamped beam, (lambda / L)^2 sqrt(E I / mu) / (2 pi), and the damping ratios
// that the file gives it.
TEST(Tutorial14, LeadsFromAFileToItsModes) {
  Workplace place;
  fs::copy(source("docs/tutorials/14_from_file_to_modes/rig.toml"), place.folder() / "rig.toml");
  for (const char* words :
       {"simulate --config rig.toml --out made", "inspect made/record.csv",
        "prepare --config rig.toml --out prepared", "modal --config rig.toml --out modes"}) {
    const Outcome outcome = place.run(words);
    ASSERT_EQ(outcome.code, 0) << words << ": " << outcome.err;
  }
  const json found = json::parse(contents(place.folder() / "modes" / "results.json"))["records"][0]["modes"];
  ASSERT_EQ(found.size(), 3u);
  const double lambda[] = {1.875104, 4.694091, 7.854757}, ratio[] = {0.004, 0.002, 0.002};
  for (int m = 0; m < 3; ++m) {
    const double wave = lambda[m] / 0.759,
                 frequency = wave * wave / (2 * std::numbers::pi) * std::sqrt(205e9 / 7850 / 12) * 0.00514;
    EXPECT_NEAR(found[m]["frequency_hz"].get<double>(), frequency, 2e-5 * frequency);
    EXPECT_NEAR(found[m]["damping_ratio"].get<double>(), ratio[m], 0.002 * ratio[m]);
  }
}

}  // namespace
}  // namespace beamid::apps::inspect_and_prepare_test
