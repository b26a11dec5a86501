// beamid identify on the record that ships with the project.
#include <gmock/gmock.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <sstream>

#include "experiments/record/record.hpp"
#include "experiments/rig/virtual_rig.hpp"
#include "fem/beam.hpp"
#include "tests/apps/run_command.hpp"

namespace beamid::apps::identify_test {
namespace {

using nlohmann::json;
using testing::HasSubstr, testing::IsEmpty, testing::IsSupersetOf;

const char* const tutorial = "docs/tutorials/02_identify_a_record";

/// A folder that holds the tutorial.
class Tutorial : public testing::Test {
 protected:
  Tutorial() { fs::copy(source(tutorial), place_.folder(), fs::copy_options::recursive); }

  Workplace place_;
};

// The record is the library's own: the beam S(11.8) of [inverse2009] released from 12 mm, three modes as an
// anti-aliasing filter would leave them, an accelerometer with white noise of 0.05 m/s2.
TEST_F(Tutorial, RecordIsSimulatedAgainByteForByte) {
  experiments::Release rig;
  rig.beam =
      fem::Cantilever{1.10, 2.12e11 * fem::rectangle_second_moment(0.060, 0.006), 3.055 / 1.10, 0.36049};
  rig.modes = 3;
  rig.first_damping_ratio = 0.0045;
  rig.higher_damping_ratio = 0.02;
  rig.duration = 10;
  rig.sampling_rate = 250;
  constexpr double noise = 0.05;
  constexpr std::uint64_t seed = 1, stream = 0;
  constexpr int digits = 6;
  const auto record = experiments::measure_acceleration(experiments::release(rig), noise, seed, stream);
  EXPECT_TRUE(experiments::to_csv(record, digits) == contents(place_.folder() / "tip_acceleration.csv"));
}

TEST_F(Tutorial, GivesTheExpectedValues) {
  const Outcome outcome = place_.run("identify --config cantilever.toml --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  const json results = json::parse(outcome.out),
             expected = json::parse(contents(source(tutorial) / "expected.json"));
  for (const auto& [path, value] : expected.at("values").items())
    EXPECT_NEAR(results.at(json::json_pointer(path)).get<double>(), value.at("value").get<double>(),
                value.at("tolerance").get<double>())
        << path;
}

// Oracle: what the record was simulated with.
TEST_F(Tutorial, HasTheTruthInsideItsIntervals) {
  const json results = json::parse(place_.run("identify --config cantilever.toml --json").out),
             expected = json::parse(contents(source(tutorial) / "expected.json"));
  for (const std::string key : {"frequency_hz", "damping_ratio", "stiffness_n_per_m", "damping_n_s_per_m"}) {
    const double truth = expected.at("values").at("/" + key + "/estimate").at("truth");
    EXPECT_LT(results.at(key).at("lower_95").get<double>(), truth) << key;
    EXPECT_GT(results.at(key).at("upper_95").get<double>(), truth) << key;
  }
}

TEST_F(Tutorial, TakesTheRecordFromTheCommandLineOrFromTheFile) {
  EXPECT_EQ(place_.run("identify tip_acceleration.csv --config cantilever.toml --json").out,
            place_.run("identify --config cantilever.toml --json").out);
}

TEST_F(Tutorial, FindsTheSameWithTheUnscentedFilter) {
  std::string text = contents(place_.folder() / "cantilever.toml");
  text.replace(text.find("\"ekf\""), 5, "\"ukf\"");
  place_.write("ukf.toml", text);
  const json ekf = json::parse(place_.run("identify --config cantilever.toml --json").out),
             ukf = json::parse(place_.run("identify --config ukf.toml --json").out);
  for (const char* key : {"stiffness_n_per_m", "damping_n_s_per_m"})
    EXPECT_NEAR(ukf.at(key).at("estimate").get<double>(), ekf.at(key).at("estimate").get<double>(),
                ekf.at(key).at("standard_deviation").get<double>());
}

TEST_F(Tutorial, PrintsATableAndWritesTheWholeSet) {
  const Outcome outcome = place_.run("identify --config cantilever.toml --out results");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  for (const char* text : {"frequency [Hz]", "damping ratio [%]", "stiffness K [N/m]", "damping C [N s/m]",
                           "Innovations: ", "\nWritten to results\n"})
    EXPECT_THAT(outcome.out, HasSubstr(text));
  std::vector<std::string> expected{"results/report.html", "results/results.json", "results/timing.json",
                                    "results/parameters.csv"};
  for (const char* figure :
       {"convergence", "reproduction", "spectrum", "innovation_autocorrelation", "innovation_histogram"})
    for (const char* ending : {".svg", ".png", ".gp", ".csv"})
      expected.push_back(std::string("results/") + figure + ending);
  EXPECT_THAT(place_.files(), IsSupersetOf(expected));
}

// Oracle: the start of a filter knows the prior alone; a smoother knows K as well there as at the end.
TEST_F(Tutorial, WritesWhatTheSmootherSays) {
  const Outcome outcome = place_.run("identify --config cantilever.toml --smoother rts --out results");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  std::istringstream history(contents(place_.folder() / "results/smoothed.csv"));
  std::string header, first, value;
  std::getline(history, header);
  std::getline(history, first);
  EXPECT_EQ(header.substr(0, header.find(",stiffness")),
            "time_s,displacement_m,displacement_deviation_m,velocity_m_per_s,velocity_deviation_m_per_s");
  std::istringstream row(first);
  for (int column = 0; column < 6; ++column) std::getline(row, value, ',');
  const json stiffness =
      json::parse(contents(place_.folder() / "results/results.json")).at("stiffness_n_per_m");
  EXPECT_NEAR(std::stod(value), stiffness.at("estimate").get<double>(),
              0.1 * stiffness.at("standard_deviation").get<double>());
}

TEST_F(Tutorial, RefusesUnknownResponsesAndSmoothers) {
  EXPECT_EQ(place_.run("identify --config cantilever.toml --on-failure hope").first_error_line(),
            "beamid: identify: --on-failure is 'hope'; expected stop, inflate or report");
  EXPECT_EQ(place_.run("identify --config cantilever.toml --smoother tsr").first_error_line(),
            "beamid: identify: --smoother is 'tsr'; expected rts or urts; did you mean 'rts'?");
}

TEST_F(Tutorial, WritesTheSameBytesTwice) {
  place_.run("identify --config cantilever.toml --out one");
  place_.run("identify --config cantilever.toml --out two");
  for (const auto& entry : fs::directory_iterator(place_.folder() / "one")) {
    const std::string name = entry.path().filename().string();
    if (name == "timing.json") continue;
    EXPECT_TRUE(contents(entry.path()) == contents(place_.folder() / "two" / name)) << name;
  }
}

TEST_F(Tutorial, UsesTheWindowOfTheCommandLine) {
  const json results = json::parse(place_.run("identify --config cantilever.toml --window 4 6 --json").out);
  EXPECT_NEAR(results.at("window_s")[0].get<double>(), 4.0, 1e-9);
  EXPECT_NEAR(results.at("window_s")[1].get<double>(), 6.0, 1e-9);
  EXPECT_EQ(results.at("samples"), 501);
}

// Oracle: inverse-variance weights of the two windows, whose information adds up; what one of them says is
// what it says alone.
TEST_F(Tutorial, IdentifiesSeveralRecordsTogether) {
  const std::string twice = "identify tip_acceleration.csv tip_acceleration.csv --config cantilever.toml ";
  const json both = json::parse(place_.run(twice + "--window 2 5 5 10 --json").out),
             alone = json::parse(place_.run("identify --config cantilever.toml --window 2 5 --json").out);
  ASSERT_EQ(both.at("records").size(), 2u);
  EXPECT_EQ(both.at("records")[0].at("frequency_hz"), alone.at("frequency_hz"));
  EXPECT_TRUE(both.at("agreement").at("agree").get<bool>());
  double weights = 0.0, sum = 0.0;
  for (const json& one : both.at("records")) {
    const json& found = one.at("stiffness_n_per_m");
    const double weight = std::pow(found.at("standard_deviation").get<double>(), -2);
    weights += weight;
    sum += weight * found.at("estimate").get<double>();
  }
  const json& stiffness = both.at("stiffness_n_per_m");
  const double deviation = stiffness.at("standard_deviation");
  EXPECT_NEAR(deviation * std::sqrt(weights), 1.0, 0.05);  // Student's factor is smaller for both
  EXPECT_NEAR(stiffness.at("estimate").get<double>(), sum / weights, 0.1 * deviation);
  const Outcome shown = place_.run(twice + "--window 2 5 5 10 --out results");
  EXPECT_THAT(shown.out, HasSubstr("The records agree within their noise"));
  EXPECT_THAT(place_.files(),
              IsSupersetOf(std::vector<std::string>{"results/agreement.png", "results/records.csv"}));
}

TEST_F(Tutorial, IdentifiesAnyModelFromSeveralRecords) {
  place_.write("modal.toml",
               contents(place_.folder() / "cantilever.toml") + "\n[model]\nname = \"modal\"\nmodes = 1\n");
  const json both = json::parse(place_
                                    .run("identify tip_acceleration.csv tip_acceleration.csv --config "
                                         "modal.toml --window 2 5 5 10 --json")
                                    .out);
  const json& frequency = both.at("parameters").at("frequency_1");
  EXPECT_LT(frequency.at("lower_95").get<double>(), 3.455527194845);  // as simulated
  EXPECT_GT(frequency.at("upper_95").get<double>(), 3.455527194845);
  double weights = 0.0;
  for (const json& one : both.at("records"))
    weights += std::pow(one.at("parameters").at("frequency_1").at("standard_deviation").get<double>(), -2);
  // below 1: the noise at the mode is known with the degrees of freedom of both records, so that Student's
  // factor, 1.02 to 1.05 for one record alone, is nearer to 1
  const double ratio = frequency.at("standard_deviation").get<double>() * std::sqrt(weights);
  EXPECT_LT(ratio, 1.0);
  EXPECT_GT(ratio, 0.97);
}

TEST_F(Tutorial, RefusesWhatSeveralRecordsCannotHave) {
  const std::string twice = "identify tip_acceleration.csv tip_acceleration.csv --config cantilever.toml ";
  EXPECT_EQ(place_.run(twice + "--window 2 5 5").first_error_line(),
            "beamid: identify: --window has 3 times for 2 records; expected FROM TO once for all, or once "
            "for each");
  EXPECT_EQ(place_.run(twice + "--smoother rts").first_error_line(),
            "beamid: identify: a smoother takes one RECORD");
}

// Oracle: the record was simulated with viscous damping, in all of its parts.
TEST_F(Tutorial, FindsOneDampingLawInTwoPartsOfARecord) {
  const Outcome outcome = place_.run(
      "identify tip_acceleration.csv tip_acceleration.csv --config cantilever.toml --window 2 9 3 10 "
      "--damping-law auto --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json found = json::parse(outcome.out);
  ASSERT_EQ(found.at("compared_laws").size(), 2u);
  for (const json& one : found.at("compared_laws")) EXPECT_TRUE(one.at("holds").get<bool>()) << one;
  for (const json& one : found.at("records")) EXPECT_EQ(one.at("supported"), "viscous");
}

// Oracle: the truth. Higher modes are in the first seconds, and kept from the filter without being told.
TEST_F(Tutorial, HasTheTruthInsideItsIntervalsOverTheWholeRecord) {
  const Outcome outcome = place_.run("identify --config cantilever.toml --window 0 10 --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json results = json::parse(outcome.out);
  EXPECT_NEAR(results.at("frequency_hz").at("estimate").get<double>(), 3.455527194845,
              3.3 * results.at("frequency_hz").at("standard_deviation").get<double>());
  EXPECT_NEAR(results.at("damping_ratio").at("estimate").get<double>(), 0.0045,
              3.3 * results.at("damping_ratio").at("standard_deviation").get<double>());
  EXPECT_LT(results.at("samples").get<int>(), 400);
}

// Oracle: the closed form. lambda_f = (e^(lambda dt) - 1)/dt, C_f = -2 M Re lambda_f.
TEST_F(Tutorial, ShowsTheBiasOfForwardEuler) {
  std::string text = contents(place_.folder() / "cantilever.toml");
  text.replace(text.find("\"exponential\""), 13, "\"forward_euler\"");
  place_.write("euler.toml", text);
  const json results = json::parse(place_.run("identify --config euler.toml --json").out);
  const double w = 2.0 * std::numbers::pi * 3.455527194845, ratio = 0.0045, dt = 0.004,
               mass = results.at("equivalent_mass_kg");
  const std::complex<double> rate(-ratio * w, w * std::sqrt(1.0 - ratio * ratio));
  const double predicted = -2.0 * mass * ((std::exp(rate * dt) - 1.0) / dt).real();
  EXPECT_NEAR(results.at("damping_n_s_per_m").at("estimate").get<double>(), predicted, 2e-3 * predicted);
}

// A script sees by the exit code alone that there is no estimate, and a reader in the first line why.
TEST_F(Tutorial, HasAnExitCodeForADivergedFilterAndForAContradictedOne) {
  const std::string file = contents(place_.folder() / "cantilever.toml");
  place_.write("diverged.toml", file + "[noise]\nacceleration_m_per_s2 = 1e-12\n");
  std::string text = file;
  text.replace(text.find("\"exponential\""), 13, "\"forward_euler\"");
  place_.write("euler.toml", text);
  const Outcome diverged = place_.run("identify --config diverged.toml --json"),
                contradicted = place_.run("identify --config euler.toml --json");
  EXPECT_EQ(diverged.code, 3) << diverged.err;
  EXPECT_EQ(json::parse(diverged.out).at("status"), "diverged");
  EXPECT_THAT(json::parse(diverged.out).at("messages")[0].at("text").get<std::string>(),
              HasSubstr("DIVERGED: sample "));
  EXPECT_EQ(contradicted.code, 3) << contradicted.err;
  EXPECT_EQ(json::parse(contradicted.out).at("status"), "contradicted");
  EXPECT_THAT(json::parse(contradicted.out).at("messages")[0].at("text").get<std::string>(),
              HasSubstr("forward_euler at 4 ms makes C 965 % too large and K 0.102 % too small"));
  EXPECT_EQ(place_.run("identify --config cantilever.toml --json").code, 0);
  EXPECT_THAT(place_.run("identify --help").out, HasSubstr("\n  3    no estimate to rely on"));
}

// Oracle: identify, which is asked for one reduction where compare is asked for two; both decide alike about
// the record, its window, its higher modes and its noise.
TEST_F(Tutorial, IsIdentifiedToTheLastDigitByCompareToo) {
  std::string silent = contents(place_.folder() / "cantilever.toml");
  silent.erase(silent.find("window_s"), silent.find('\n', silent.find("window_s")) - silent.find("window_s"));
  silent += "[model]\nname = \"beam\"\n";
  std::istringstream record(contents(place_.folder() / "tip_acceleration.csv"));
  std::string line, at_rest;
  std::getline(record, at_rest);
  at_rest += "\n";
  for (int k = 0; k < 500; ++k)
    at_rest += std::to_string(0.004 * k) + "," + std::to_string(0.05 * (k * 7919 % 101 / 50.0 - 1.0)) + "\n";
  while (std::getline(record, line))
    at_rest += std::to_string(2.0 + std::stod(line)) + line.substr(line.find(',')) + "\n";
  place_.write("at_rest.csv", at_rest);
  place_.write("likeliest.toml", silent);
  place_.write("quiet.toml", silent + "[noise]\nmethod = \"before_event\"\n");
  for (const std::string words :
       {"tip_acceleration.csv --config likeliest.toml --json", "at_rest.csv --config quiet.toml --json"}) {
    const Outcome one = place_.run("identify " + words),
                  both =
                      place_.run("compare " + words + " --reduction modal_truncation --reduction rayleigh");
    ASSERT_EQ(one.code, 0) << one.err;
    ASSERT_EQ(both.code, 0) << both.err;
    EXPECT_EQ(json::parse(one.out).at("runs").at(0).at("parameters"),
              json::parse(both.out).at("runs").at(0).at("parameters"))
        << words;
  }
}

TEST_F(Tutorial, HasAnExitCodeForAComparisonWithoutAnEstimateToo) {
  std::string text = contents(place_.folder() / "cantilever.toml");
  text.replace(text.find("\"exponential\""), 13, "\"forward_euler\"");
  place_.write("euler.toml", text);
  const Outcome outcome =
      place_.run("compare tip_acceleration.csv --config euler.toml --reduction rayleigh --json");
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  const json results = json::parse(outcome.out);
  EXPECT_EQ(results.at("status"), "contradicted");
  EXPECT_EQ(results.at("messages").at(0).at("severity"), "failure");
  EXPECT_EQ(place_
                .run("compare tip_acceleration.csv --config euler.toml --reduction rayleigh "
                     "--discretisation forward_euler --discretisation exponential")
                .code,
            0);
}

}  // namespace
}  // namespace beamid::apps::identify_test
