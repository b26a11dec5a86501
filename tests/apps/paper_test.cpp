// beamid paper, end to end. What its numbers are worth is tested in tests/experiments; here: what a user
// gets.
#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::paper_test {
namespace {

using nlohmann::json;
using testing::ElementsAre, testing::EndsWith, testing::HasSubstr, testing::IsEmpty, testing::StartsWith;

const std::vector<std::string> schemes{"forward_euler", "backward_euler", "implicit_midpoint",
                                       "runge_kutta_2", "runge_kutta_4",  "exponential"};

const Outcome& printed_json() {
  static const Outcome outcome = Workplace().run("paper --trials 4 --json");
  return outcome;
}

TEST(PaperJson, IsAllThatStandardOutputHolds) {
  EXPECT_EQ(printed_json().code, 0);
  EXPECT_THAT(printed_json().err, IsEmpty());
  EXPECT_TRUE(json::accept(printed_json().out));
}

TEST(PaperJson, SaysWhatMadeIt) {
  const json results = json::parse(printed_json().out);
  EXPECT_EQ(results.at("program"), "beamid");
  EXPECT_EQ(results.at("command"), "paper");
  EXPECT_EQ(results.at("seed"), 2009);
  EXPECT_EQ(results.at("configuration").at("trials"), 4);
  EXPECT_TRUE(results.at("schema_version").is_number_integer());
  EXPECT_TRUE(results.at("version").is_string());
}

// Oracle: the errors that the 2009 paper printed [inverse2009].
TEST(PaperJson, HoldsThePublishedErrorsForForwardEuler) {
  const json euler = json::parse(printed_json().out).at("table2").at("forward_euler");
  EXPECT_NEAR(std::abs(euler.at("stiffness_error_percent").get<double>()), 0.13, 0.005);
  EXPECT_NEAR(euler.at("damping_error_percent").get<double>(), 6.41, 0.005);
}

// Oracle: the closed form printed beside the filter's result, 4 digits or 1e-7 %.
TEST(PaperJson, HoldsBiasOfEverySchemeAsPredicted) {
  const json results = json::parse(printed_json().out);
  for (const std::string& scheme : schemes) {
    const json& bias = results.at("discretisation_bias").at(scheme);
    for (const std::string quantity : {"stiffness", "damping"}) {
      const double predicted = bias.at("predicted_" + quantity + "_error_percent"),
                   found = bias.at(quantity + "_error_percent");
      EXPECT_NEAR(found, predicted, std::max(1e-7, 5e-5 * std::abs(predicted))) << scheme << ' ' << quantity;
    }
  }
}

TEST(PaperJson, HoldsFiveBeamsWithEveryKey) {
  const json beams = json::parse(printed_json().out).at("beams");
  std::vector<std::string> names;
  for (const json& beam : beams) {
    names.push_back(beam.at("name"));
    for (const char* key : {"tip_mass_kg", "frequency_hz", "assumed_damping_ratio", "equivalent_mass_kg"})
      EXPECT_TRUE(beam.at(key).is_number()) << key;
    for (const char* key : {"frequency_hz", "damping_ratio"})
      EXPECT_TRUE(beam.at("modal_analysis").at(key).is_number()) << key;
    for (const char* filter : {"ekf", "ukf"})
      for (const char* scheme : {"forward_euler", "exponential"})
        for (const char* key :
             {"stiffness_n_per_m", "damping_n_s_per_m", "damping_ratio", "stiffness_error_percent",
              "damping_error_percent", "predicted_damping_error_percent",
              "stiffness_standard_deviation_n_per_m", "damping_standard_deviation_n_s_per_m"})
          EXPECT_TRUE(beam.at(filter).at(scheme).at(key).is_number())
              << filter << ' ' << scheme << ' ' << key;
  }
  EXPECT_THAT(names, ElementsAre("S(0.65)", "S(11.8)", "S(43.8)", "S(76.3)", "S(119.3)"));
}

class PaperFiles : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    place_ = new Workplace;
    first_ = place_->run("paper --trials 4 --out one");
    second_ = place_->run("paper --trials 4 --out deeper/two");
  }
  static void TearDownTestSuite() {
    delete place_;
    place_ = nullptr;
  }
  static std::vector<std::string> files_in(const std::string& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(place_->folder() / folder))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }
  static inline Workplace* place_ = nullptr;
  static inline Outcome first_, second_;
};

TEST_F(PaperFiles, AreTheWholeSet) {
  EXPECT_EQ(first_.code, 0) << first_.err;
  EXPECT_THAT(first_.out, HasSubstr("\nWritten to one\n"));
  std::vector<std::string> expected{"report.html", "results.json", "timing.json", "modes.pvd"};
  for (const char* figure :
       {"figure_2", "figure_3", "figure_5", "figure_6", "damping_law", "step_experiment", "generator_matrix",
        "predicted_differences", "bias_by_process_noise", "error_by_start"})
    for (const char* ending : {".svg", ".png", ".gp", ".csv"})
      expected.push_back(figure + std::string(ending));
  for (const char* table : {"table_1", "table_2", "table_3", "table_4", "table_5", "discretisation_bias"})
    expected.push_back(table + std::string(".csv"));
  EXPECT_THAT(files_in("one"), testing::IsSupersetOf(expected));
  for (const std::string& file : files_in("one"))
    EXPECT_GT(fs::file_size(place_->folder() / "one" / file), 0u);
}

TEST_F(PaperFiles, ComeWithATextThatTellsTheFindingFirstAndFitsATerminal) {
  EXPECT_THAT(first_.err, IsEmpty());
  EXPECT_THAT(first_.out, StartsWith("The finding\n===========\n"));
  for (const char* text : {"Table 1.", "Table 2.", "Table 3.", "Table 4.", "Table 5.", "6.41 %", "10^+5"})
    EXPECT_THAT(first_.out, HasSubstr(text));
  std::istringstream lines(first_.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 110u) << line;  // bytes
}

TEST_F(PaperFiles, AreThoseThatResultsJsonLists) {
  const json results = json::parse(contents(place_->folder() / "one" / "results.json"));
  EXPECT_EQ(results.at("files").get<std::vector<std::string>>(), files_in("one"));
}

TEST_F(PaperFiles, AreTheSameBytesForTheSameSeed) {
  EXPECT_EQ(second_.code, 0) << second_.err;
  ASSERT_EQ(files_in("one"), files_in("deeper/two"));
  for (const std::string& file : files_in("one"))
    if (file != "timing.json") {
      EXPECT_TRUE(contents(place_->folder() / "one" / file) ==
                  contents(place_->folder() / "deeper/two" / file))
          << file;
    }
}

TEST_F(PaperFiles, AreAsPrintedWithJson) {
  EXPECT_EQ(contents(place_->folder() / "one" / "results.json"), printed_json().out);
}

TEST_F(PaperFiles, AreNotReplacedWithoutForce) {
  const Outcome refused = place_->run("paper --trials 4 --seed 1 --out one");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.out, IsEmpty());
  EXPECT_EQ(
      refused.first_error_line(),
      "beamid: output folder 'one' is not empty; choose another one, or replace its results with --force");
  EXPECT_EQ(json::parse(contents(place_->folder() / "one" / "results.json")).at("seed"), 2009);
}

TEST(Paper, OtherSeedsGiveOtherNoiseButTheSameOscillator) {
  const json one = json::parse(printed_json().out),
             other = json::parse(Workplace().run("paper --trials 4 --json --seed 7").out);
  EXPECT_EQ(one.at("table2"), other.at("table2"));
  EXPECT_NE(one.at("beams"), other.at("beams"));
}

TEST(Paper, RefusesAFolderBelowAFile) {
  Workplace place;
  place.write("taken", "a file");
  const Outcome outcome = place.run("paper --out taken/results");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.first_error_line(), StartsWith("beamid: output folder 'taken/results': '"));
  EXPECT_THAT(outcome.first_error_line(), EndsWith("taken' is a file; expected a folder"));
}

struct BadOption {
  const char* name;
  const char* words;
  const char* message;
};
void PrintTo(const BadOption& option, std::ostream* stream) {
  *stream << option.words;
}

class PaperOption : public testing::TestWithParam<BadOption> {};

TEST_P(PaperOption, IsRefused) {
  Workplace place;
  place.write("taken", "a file");
  const Outcome outcome = place.run(std::string("paper ") + GetParam().words);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_EQ(outcome.first_error_line(), GetParam().message);
  EXPECT_THAT(place.files(), ElementsAre("taken"));
}

INSTANTIATE_TEST_SUITE_P(
    Bad, PaperOption,
    testing::Values(
        BadOption{"OutIsAFile", "--out taken",
                  "beamid: output folder 'taken' is a file; expected a folder or a new name"},
        BadOption{"OutIsHere", "--out .",
                  "beamid: output folder '.' holds the current folder; expected another one, which can be "
                  "replaced whole"},
        BadOption{"OutWithoutName", "--out", "beamid: paper: option '--out' needs a value: DIR"},
        BadOption{"OneTrial", "--trials 1", "beamid: trials must be a whole number from 2 to 1000000"},
        BadOption{"HalfASeed", "--seed 0.5", "beamid: seed must be a whole number from 0"},
        BadOption{"TextForANumber", "--trials many", "beamid: paper: --trials is 'many'; expected a number"},
        BadOption{
            "Words", "again",
            "beamid: paper: unexpected argument 'again'; expected: beamid paper [OPTIONS] [--out DIR]"}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace beamid::apps::paper_test
