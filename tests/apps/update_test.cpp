// beamid update and beamid twins, end to end: what a user gets.
#include <gmock/gmock.h>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::update_test {
namespace {

using nlohmann::json, testing::HasSubstr;

class Update : public testing::Test {
 protected:
  Update() {
    const fs::path tutorial = source("docs/tutorials/16_six_buildings");
    for (const char* file : {"frame.toml", "frequencies.toml", "shapes.toml"})
      fs::copy(tutorial / file, place_.folder() / file);
  }
  Workplace place_;
};

// Oracle: SCIENCE.md, section 9, in lbf/in of 175.127 N/m.
TEST_F(Update, TwinsListsAllSixBuildingsFirst) {
  const json found =
      json_of(place_.run("twins frequencies.toml --config frame.toml --model-error 0.05 --json"));
  EXPECT_EQ(found["sets_that_fit_as_well"], 6);
  EXPECT_EQ(found["complete"], true);
  EXPECT_THAT(found["messages"].dump(), HasSubstr("6 sets of parameters"));
  const double second = found["sets"][1]["parameters"]["storey_stiffness_1"];
  EXPECT_NEAR(second / 175.1268, 7.18, 0.01);
}

TEST_F(Update, WritesParametersModesAndAFigure) {
  const Outcome outcome = place_.run("update shapes.toml --config frame.toml --out found");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::StartsWith("One set of parameters explains the modes"));
  for (const char* file :
       {"results.json", "report.html", "parameters.csv", "modes.csv", "sets.csv", "updated_parameters.png"})
    EXPECT_TRUE(fs::exists(place_.folder() / "found" / file)) << file;
}

// Shapes in m/s2 with phases, one sensor's name at each channel: what `beamid modal` writes.
TEST_F(Update, ReadsTheResultsOfModalAsTheyAre) {
  place_.write("two.toml",
               "[chain]\nmasses_kg = [1, 1]\nstiffnesses_n_per_m = [100, 100]\n"
               "[[sensors]]\nname = \"low\"\nposition_m = 1\n[[sensors]]\nname = \"high\"\nposition_m = 2\n");
  // w^2 = 100 (3 -+ sqrt 5) / 2, shapes 1 : (1 + sqrt 5) / 2 and 1 : (1 - sqrt 5) / 2
  place_.write("results.json", R"({"command": "modal", "records": [{"modes": [
    {"frequency_hz": 0.983632, "frequency_standard_deviation_hz": null, "shape": [
      {"channel": "high", "unit": "m/s2", "amplitude": 1.618034, "phase_rad": 0.3},
      {"channel": "low", "unit": "m/s2", "amplitude": 1.0, "phase_rad": 0.3}]},
    {"frequency_hz": 2.575181, "frequency_standard_deviation_hz": 0.01, "shape": [
      {"channel": "high", "unit": "m/s2", "amplitude": 0.618034, "phase_rad": 2.0},
      {"channel": "low", "unit": "m/s2", "amplitude": 1.0, "phase_rad": -1.141593}]}]}]})");
  const json found = json_of(place_.run("update results.json --config two.toml --json"));
  EXPECT_EQ(found["status"], "one set");
  EXPECT_NEAR(found["parameters"][0]["estimate"].get<double>(), 100.0, 0.01);
  EXPECT_NEAR(found["modes"][1]["mac"].get<double>(), 1.0, 1e-6);
}

// What `beamid modes` and `beamid modal` write for other programs. Oracle: the description that made them,
// and the results.json of the same modes. Six digits of a frequency.
TEST_F(Update, ReadsUniversalFilesOfBothCommands) {
  ASSERT_EQ(place_.run("modes --config frame.toml --out exact").code, 0);
  const json exact = json_of(place_.run("update exact/modes.uff --config frame.toml --json"));
  for (const json& parameter : exact["parameters"])
    EXPECT_NEAR(parameter["estimate"].get<double>(), 1751.3, 1e-5 * 1751.3);
  EXPECT_EQ(exact["messages"].dump().find("in their order"),
            std::string::npos);  // nodes at the positions of the sensors

  place_.write("damped.toml",
               contents(place_.folder() / "frame.toml") + "\n[damping]\nlaw = \"modal\"\nratio = 0.01\n");
  ASSERT_EQ(place_.run("simulate --config damped.toml --duration 60 --sampling-rate 50 --out simulated").code,
            0);
  ASSERT_EQ(place_.run("modal simulated/record.csv --out found").code, 0);
  const json universal = json_of(place_.run("update found/modes.uff --config frame.toml --json")),
             own = json_of(place_.run("update found/results.json --config frame.toml --json"));
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_NEAR(
        universal["parameters"][k]["estimate"].get<double>() / own["parameters"][k]["estimate"].get<double>(),
        1.0, 1e-4);
  for (const char* command : {"twins", "check"})
    EXPECT_EQ(place_.run(std::string(command) + " found/modes.uff --config frame.toml").code, 0) << command;
}

// Shapes of sensors 3 and 4 exchanged: nothing explains them, and a script learns it, too.
TEST_F(Update, EndsWithThreeWhereNothingExplainsTheModes) {
  place_.write("wrong.toml",
               "[[modes]]\nfrequency_hz = 0.8829\nshape = [0.41, 0.74, 1.01, 0.92]\n"
               "[[modes]]\nfrequency_hz = 2.7477\nshape = [1.03, 0.75, -0.73, -0.21]\n"
               "[[modes]]\nfrequency_hz = 4.2998\nshape = [1.00, -0.95, 0.55, -0.33]\n"
               "[[modes]]\nfrequency_hz = 5.5295\nshape = [0.19, -0.50, -0.57, 1.02]\n");
  for (const char* command : {"update", "twins"}) {
    const Outcome outcome = place_.run(std::string(command) + " wrong.toml --config frame.toml --json");
    EXPECT_EQ(outcome.code, 3);
    const json found = json::parse(outcome.out);
    EXPECT_EQ(found["status"], "not explained");
    EXPECT_EQ(found["messages"][0]["severity"], "failure");
    EXPECT_THAT(found["messages"].dump(), HasSubstr("With sensors 3 and 4 exchanged"));
  }
}

// What the modal analysis warned of is said again where its modes are used.
TEST_F(Update, RepeatsTheWarningsOfModal) {
  place_.write("results.json", R"({"command": "modal", "records": [{"modes": [
    {"frequency_hz": 0.8829, "shape": []}]}],
    "messages": [{"severity": "note", "text": "Butterworth."},
                 {"severity": "warning", "text": "A hand held the frame."}]})");
  const std::string messages =
      json_of(place_.run("update results.json --config frame.toml --json"))["messages"].dump();
  EXPECT_THAT(messages, HasSubstr("beamid modal warned of these modes: A hand held the frame."));
  EXPECT_THAT(messages, testing::Not(HasSubstr("Butterworth")));
}

TEST_F(Update, TakesTheFrequenciesOfHits) {
  place_.write("one.toml", "[chain]\nmasses_kg = [1]\nstiffnesses_n_per_m = [90]\n");
  place_.write("results.json", R"({"command": "modal", "records": ["hits.csv"], "modes": [
    {"frequency_hz": 1.5915494309, "frequency_standard_deviation_hz": 0.001}]})");
  const json found = json_of(place_.run("update results.json --config one.toml --json"));
  EXPECT_NEAR(found["parameters"][0]["estimate"].get<double>(), 100.0, 1e-4);  // (2 pi f)^2
  EXPECT_THAT(found["messages"].dump(), HasSubstr("the frequencies are used, and no shapes"));
}

TEST_F(Update, RefusesWhatMakesNoSense) {
  place_.write("wrong.toml", "[[modes]]\nfrequency_hz = 1\nshape = [1, 2]\n");
  EXPECT_EQ(place_.run("update wrong.toml --config frame.toml").first_error_line(),
            "wrong.toml:3:9: modes.shape has 2 numbers; expected 4, one for each of the [[sensors]] of "
            "the experiment file, in their order");
  place_.write("negative.toml", "[[modes]]\nfrequency_hz = -1\n");
  EXPECT_THAT(place_.run("update negative.toml --config frame.toml").first_error_line(),
              HasSubstr("negative.toml:2:16: modes[1].frequency_hz is -1; expected"));
  place_.write("other.toml", "[[modes]]\nfrequency = 1\n");
  EXPECT_THAT(place_.run("update other.toml --config frame.toml").first_error_line(),
              HasSubstr("other.toml:2:1: unknown key modes.frequency; expected one of: frequency_hz"));
  place_.write("many.toml", "[[modes]]\nfrequency_hz = 1\nmode = 5\n");
  const Outcome many = place_.run("update many.toml --config frame.toml");
  EXPECT_EQ(many.code, 2);
  EXPECT_THAT(many.first_error_line(), HasSubstr("structure that has 4"));
  place_.write("check.json", "{\"command\": \"check\"}");
  EXPECT_THAT(place_.run("update check.json --config frame.toml").first_error_line(),
              HasSubstr("results of the command 'check'; expected those of modal"));
  EXPECT_EQ(place_.run("update --config frame.toml").code, 2);
  EXPECT_EQ(place_.run("update frequencies.toml --config frame.toml --model-error 0").code, 2);
}

}  // namespace
}  // namespace beamid::apps::update_test
