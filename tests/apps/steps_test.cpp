// beamid steps, end to end, on the tutorials' simulated record.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::steps_test {
namespace {

using nlohmann::json, testing::HasSubstr, testing::StartsWith;

class Steps : public testing::Test {
 protected:
  Steps() {
    const fs::path tutorial = source("docs/tutorials/02_identify_a_record");
    for (const char* file : {"cantilever.toml", "tip_acceleration.csv"})
      fs::copy(tutorial / file, place_.folder() / file);
  }
  Workplace place_;
};

// Oracle: the record was simulated with 0.45 %; xi_f - xi = w dt / 2 = 4.34 percentage points at 4 ms.
TEST_F(Steps, SayFirstHowWrongTheSchemeIsOnThisRecord) {
  const Outcome outcome = place_.run("steps tip_acceleration.csv --config cantilever.toml --out found");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string first = outcome.out.substr(outcome.out.find("\n\n") + 2);
  EXPECT_THAT(first,
              StartsWith("On tip_acceleration.csv a forward_euler filter at steps of 4 ms finds a damping"));
  for (const char* file : {"results.json", "report.html", "steps.csv", "extrapolation.csv", "step_size.svg"})
    EXPECT_TRUE(fs::exists(place_.folder() / "found" / file)) << file;
  const json found = json::parse(contents(place_.folder() / "found" / "results.json"));
  const json& euler = found.at("schemes")[1];
  EXPECT_EQ(euler.at("discretisation"), "forward_euler");
  EXPECT_NEAR(euler.at("steps")[0].at("found").at("damping_ratio").get<double>(), 0.0045 + 0.0434, 1e-4);
  EXPECT_NEAR(euler.at("extrapolated").at("damping_ratio").get<double>(), 0.0045, 1e-4);
}

// Oracle: an extended Kalman filter of another program on the same record and window, decimated by its own
// low-pass: 3.4234, 5.5550, 9.8084, 18.2494 %, exact 1.290, 1.290, 1.289, 1.289 %. Which samples are kept
// moves both by up to 0.0006 percentage points, 5 % of a standard deviation; filter and closed form agree to
// 1e-4 of them.
TEST_F(Steps, OnAMeasuredRecordAreThoseOfAnIndependentProgram) {
  const fs::path record = source("../shared/data/unb-tip-mass/massa1_test1-1.txt");
  if (!fs::exists(record)) GTEST_SKIP() << "the measured records are not here";
  const json found =
      json_of(place_.run("steps '" + record.string() + "' --config '" +
                         source("docs/tutorials/03_your_own_file/massa1.toml").string() + "' --json"));
  const json &exact = found.at("schemes")[0].at("steps"), &euler = found.at("schemes")[1].at("steps");
  const double expected[] = {0.034234, 0.055550, 0.098084, 0.182494};
  ASSERT_EQ(euler.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    const double ratio = euler[k].at("found").at("damping_ratio");
    EXPECT_NEAR(ratio, expected[k], 7e-6) << k;
    EXPECT_NEAR(ratio, euler[k].at("predicted").at("damping_ratio").get<double>(), 1e-6) << k;
    EXPECT_NEAR(exact[k].at("found").at("damping_ratio").get<double>(), 0.01290, 1.1e-5) << k;
    EXPECT_NEAR(euler[k].at("mean_nis").get<double>(), exact[k].at("mean_nis").get<double>(), 1e-3) << k;
  }
  EXPECT_NEAR(found.at("schemes")[1].at("extrapolated").at("damping_ratio").get<double>(), 0.0129, 5e-5);
}

// Oracle: what identify finds with the scheme, and the truth.
TEST_F(Steps, FindWhatLayBehindAPublishedValue) {
  const json found = json_of(
      place_.run("steps --published-xi 0.047900 --scheme forward_euler --config cantilever.toml --json"));
  EXPECT_NEAR(found.at("damping_ratio").at("behind_it").get<double>(), 0.0045, 1e-5);
  EXPECT_NEAR(found.at("record").at("damping_ratio").get<double>(), 0.0045, 2e-5);
  const json stated = json_of(place_.run(
      "steps --published-xi 0.0479 --scheme forward_euler --interval 0.004 --frequency 3.453758 --json"));
  EXPECT_NEAR(stated.at("damping_ratio").at("behind_it").get<double>(), 0.0045, 1e-5);
  EXPECT_NEAR(stated.at("damping_ratio").at("upper").get<double>(), 0.0045 + 5e-5, 1e-5);
}

TEST_F(Steps, SayThatNoStructureGivesTheValue) {
  const Outcome outcome =
      place_.run("steps --published-xi 0.02 --scheme forward_euler --interval 0.004 --frequency 3.4555");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.out, HasSubstr("NOT POSSIBLE"));
}

// Oracles: the truth, two ratios of 1 %; xi_f = sin(w dt / 2) + ... of forward Euler, mode by mode; a step of
// zero by the powers of the step alone.
TEST_F(Steps, OfAWholeModelFollowTheLawOfManyDegreesOfFreedom) {
  place_.write("two.toml",
               "[chain]\nmasses_kg = [1000, 900]\nstiffnesses_n_per_m = [2.0e6, 1.2e6]\nheights_m = [3, 3]\n"
               "[damping]\nlaw = \"modal\"\nratio = 0.01\n"
               "[excitation]\nkind = \"release\"\nposition_m = 6\ndeflection_m = 0.01\n"
               "[simulation]\nduration_s = 10\nsampling_rate_hz = 500\nframes = 0\n"
               "[[sensors]]\nquantity = \"acceleration\"\nposition_m = 3\nnoise_m_per_s2 = 1e-4\n"
               "[[sensors]]\nquantity = \"acceleration\"\nposition_m = 6\nnoise_m_per_s2 = 1e-4\n"
               "[model]\nname = \"beam\"\n[reduction]\nmethod = \"none\"\n"
               "[[parameters]]\nquantity = \"storey_stiffness\"\nfrom_m = 0\nto_m = 3\n"
               "[[parameters]]\nquantity = \"storey_stiffness\"\nfrom_m = 3\nto_m = 6\n"
               "[[parameters]]\nquantity = \"damping_ratio\"\nmode = 1\n"
               "[[parameters]]\nquantity = \"damping_ratio\"\nmode = 2\n");
  ASSERT_EQ(place_.run("simulate --config two.toml --out made --quiet").code, 0);
  const json found =
      json_of(place_.run("steps made/record.csv --config two.toml --whole-model --discretisation "
                         "forward_euler --steps 3 --json"));
  int rows = 0;
  for (const json& row : found.at("tables").at("modes")) {
    if (row.at("discretisation") != "forward_euler") continue;
    ++rows;
    const double step = 1e-3 * row.at("step_ms").get<double>(), f = row.at("behind_frequency_hz"),
                 ratio = row.at("damping_ratio_percent");
    // Two stiffnesses and two ratios stand for the six numbers of K_f and C_f.
    EXPECT_NEAR(row.at("behind_damping_ratio_percent").get<double>(), 1.0, 0.03 * ratio);
    EXPECT_NEAR(ratio, 1.0 + 100.0 * std::sin(std::numbers::pi * f * step), 0.03 * ratio);
  }
  EXPECT_EQ(rows, 6);
  for (const json& row : found.at("tables").at("parameters")) {
    if (row.at("discretisation") != "forward_euler") continue;
    const std::string name = row.at("parameter");
    const double zero = row.at("at_step_0");
    if (name.starts_with("storey"))
      EXPECT_NEAR(zero / (name.ends_with('1') ? 2.0e6 : 1.2e6), 1.0, 0.01) << name;
    else
      EXPECT_NEAR(zero, 0.01, 5e-4) << name;  // 0.036 and 0.072 at the record's own step
  }
}

TEST_F(Steps, RefuseWhatMakesNoSense) {
  for (const auto& [words, message] : std::vector<std::pair<std::string, std::string>>{
           {"steps", "beamid: steps: --config FILE is missing"},
           {"steps --config cantilever.toml --discretisation euler", "unknown discretisation 'euler'"},
           {"steps --config cantilever.toml --scheme forward_euler", "--scheme goes with --published-xi"},
           {"steps --config cantilever.toml --steps 9", "--steps is 9; expected a whole number from 1 to 8"},
           {"steps --published-xi 0.05", "--published-xi of which filter? Add --scheme NAME"},
           {"steps --published-xi 1.5 --scheme forward_euler", "--published-xi is 1.5"},
           {"steps --published-xi 0.05 --scheme forward_euler --interval 0.01",
            "--published-xi needs the filter's steps and frequency"},
           {"steps --published-xi 0.05 --scheme forward_euler --interval 0.2 --frequency 4",
            "expected above 0 and less than half of one"},
           {"steps --published-xi 0.05 --scheme euler --interval 0.01 --frequency 4",
            "unknown discretisation 'euler'"},
           {"steps --published-xi 0.05 --scheme forward_euler --steps 2",
            "--steps does not go with --published-xi"},
       }) {
    const Outcome outcome = place_.run(words);
    EXPECT_EQ(outcome.code, 2) << words;
    EXPECT_THAT(outcome.first_error_line(), HasSubstr(message)) << words;
  }
}

}  // namespace
}  // namespace beamid::apps::steps_test
