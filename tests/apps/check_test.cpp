// beamid check, end to end: what a user gets.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <complex>
#include <numbers>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::check_test {
namespace {

using nlohmann::json, testing::HasSubstr;

class Check : public testing::Test {
 protected:
  Check() {
    const fs::path tutorial = source("docs/tutorials/02_identify_a_record");
    for (const char* file : {"cantilever.toml", "tip_acceleration.csv"})
      fs::copy(tutorial / file, place_.folder() / file);
  }
  Workplace place_;
};

// Oracle: the record was simulated from the beam that the file describes.
TEST_F(Check, FindsTheTutorialsBeamRightAndWritesItsFigure) {
  const Outcome outcome = place_.run("check --config cantilever.toml --out found");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("agrees with what was identified"));
  for (const char* file :
       {"results.json", "report.html", "modes.csv", "single_changes.csv", "model_check.png"})
    EXPECT_TRUE(fs::exists(place_.folder() / "found" / file)) << file;
  EXPECT_EQ(json::parse(contents(place_.folder() / "found" / "results.json"))["status"], "agrees");
}

// Oracle: the tip mass that the description lacks, 0.05 kg of 0.36 kg.
TEST_F(Check, NamesAMissingTipMassWithItsSize) {
  std::string text = contents(place_.folder() / "cantilever.toml");
  text.replace(text.find("0.36049"), 7, "0.31049");
  place_.write("lighter.toml", text);
  const Outcome outcome = place_.run("check --config lighter.toml --candidate tip_mass --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json found = json::parse(outcome.out), change = found["single_changes"][0]["changes"][0];
  EXPECT_EQ(found["status"], "differs");
  EXPECT_EQ(found["single_changes"][0]["verdict"], "explains");
  EXPECT_LT(change["lower_95"].get<double>(), 0.05);
  EXPECT_GT(change["upper_95"].get<double>(), 0.05);
  EXPECT_NEAR(change["estimate"].get<double>(), 0.05, 0.001);
}

TEST_F(Check, PreparesTheRecordAsTheExperimentFileSays) {
  std::string text = contents(place_.folder() / "cantilever.toml");
  text.replace(text.find("[2.0, 10.0]"), 11, "[2.0, 9.9]");  // decimation shortens the record
  place_.write("prepared.toml", text + "\n[[record.prepare]]\nstep = \"decimate\"\nfactor = 2\n");
  const Outcome outcome = place_.run("check --config prepared.toml --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_EQ(found["status"], "agrees");
  EXPECT_EQ(found["preparations"][0]["record"], "tip_acceleration.csv");
  EXPECT_EQ(found["preparations"][0]["steps"][0]["step"], "decimate");
  place_.write("refused.toml", text + "\n[[record.prepare]]\nstep = \"low_pass\"\ncorner_hz = 1e5\n");
  const Outcome refused = place_.run("check --config refused.toml");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.first_error_line(), HasSubstr("step 'low_pass'"));
}

TEST_F(Check, RefusesWhatMakesNoSense) {
  for (const auto& [words, message] : std::vector<std::pair<std::string, std::string>>{
           {"check", "beamid: check: --config FILE is missing"},
           {"check --config cantilever.toml --model-error 0",
            "beamid: check: --model-error is 0; expected a number from 0.01 to 20"},
           {"check a.csv b.csv c.csv --config cantilever.toml cantilever.toml",
            "beamid: check: 3 records for 2 --config files; expected one for each, or one file for all"},
           {"check --config cantilever.toml --method frf_lscf",
            "beamid: check: --method frf_lscf needs hits with a measured force; expected era, ssi_cov or "
            "output_error"}}) {
    const Outcome outcome = place_.run(words);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.first_error_line(), message);
  }
  EXPECT_THAT(place_.run("check --config cantilever.toml --candidate clamp").err,
              HasSubstr("unknown candidate 'clamp'; known: bending_stiffness"));
}

// Four tip masses on one beam. Oracle: the differences that the catalogue's beam has from an independent fit,
// +9, +3, 0 and -7 %, of which no root that gives way can make one that is positive.
TEST(CheckOfMeasuredRecords, FindsNoSingleCauseForFourTipMasses) {
  const fs::path data = source("../shared/data/unb-tip-mass"),
                 tutorial = source("docs/tutorials/03_your_own_file");
  if (!fs::exists(data)) GTEST_SKIP() << "the measured records are not here";
  std::string records, configs;
  for (const char* name : {"massa1_test1-1", "massa2_test1-2", "massa3_test2-3", "massa4_test2-4"})
    records += " '" + (data / (std::string(name) + ".txt")).string() + "'";
  for (const char* name : {"massa1", "massa2", "massa3", "massa4_test2-4"})
    configs += " '" + (tutorial / (std::string(name) + ".toml")).string() + "'";
  const Outcome outcome = Workplace().run("check" + records + " --config" + configs + " --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_EQ(found["status"], "differs");
  EXPECT_EQ(found["modes"].size(), 5u);
  for (const json& single : found["single_changes"]) {
    EXPECT_EQ(single["verdict"], "does not explain");
    const json& change = single["changes"][0];
    if (change["candidate"] == "root_rotational_compliance") {
      EXPECT_EQ(change["estimate"].get<double>(), 0);
    }
  }
}

// A storey of 3 Hz and 1 % under a base that moves most at 1.7 Hz, where the largest motion is. Oracle: its
// exact response to a sum of sines.
class UnderAMovingBase : public testing::Test {
 protected:
  UnderAMovingBase() {
    constexpr double pi = std::numbers::pi, natural = 2.0 * pi * 3.0, ratio = 0.01;
    std::string record = "time_s,base_acceleration_m_per_s2,acceleration_m_per_s2\n";
    for (int k = 0; k < 6000; ++k) {
      double base = 0.0, storey = 0.0;
      for (int line = 1; line < 400; ++line) {
        const double hz = 0.0251 * line, omega = 2.0 * pi * hz, size = std::abs(hz - 1.7) < 0.03 ? 4.0 : 0.1;
        const std::complex<double> i(0.0, 1.0),
            spring = natural * natural + 2.0 * i * ratio * natural * omega,
            wave = size * std::exp(i * (omega * 0.01 * k + 1.3 * line * line));
        base += wave.real();
        storey += (spring / (spring - omega * omega) * wave).real();
      }
      record += fmt::format("{:.2f},{:.8g},{:.8g}\n", 0.01 * k, base, storey);
    }
    place_.write("shaken.csv", record);
    place_.write("storey.toml",
                 fmt::format("[chain]\nmasses_kg = [10]\nstiffnesses_n_per_m = [{:.9g}]\nheights_m = [3]\n"
                             "[record]\nfile = \"shaken.csv\"\n",
                             10.0 * natural * natural));
  }
  Workplace place_;
};

TEST_F(UnderAMovingBase, CheckTakesTheModesOfTheResponseToIt) {
  const Outcome outcome = place_.run("check --config storey.toml --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_EQ(found["status"], "agrees");
  ASSERT_EQ(found["modes"].size(), 1u) << found["modes"];
  EXPECT_NEAR(found["modes"][0]["identified_hz"].get<double>(), 3.0, 3e-3);
}

TEST_F(UnderAMovingBase, TrackRefusesMotionThatTheBaseMakes) {
  const Outcome outcome = place_.run("track --config storey.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.first_error_line(), HasSubstr("an input is measured that drives the motion"));
}

}  // namespace
}  // namespace beamid::apps::check_test
