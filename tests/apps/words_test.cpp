// Words of the command line: their forms, what is wrong with them, what was meant.
#include <gmock/gmock.h>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::words_test {
namespace {

using testing::HasSubstr;

class CommandLine : public testing::Test {
 protected:
  CommandLine() {
    fs::copy(source("docs/tutorials/02_identify_a_record"), place_.folder(), fs::copy_options::recursive);
  }
  std::string refusal(const std::string& words) const {
    const Outcome outcome = place_.run(words);
    EXPECT_EQ(outcome.code, 2) << words;
    EXPECT_EQ(outcome.out, "") << words;
    return outcome.first_error_line();
  }
  std::string output(const std::string& words) const {
    const Outcome outcome = place_.run(words);
    EXPECT_EQ(outcome.code, 0) << words << "\n" << outcome.err;
    return outcome.out;
  }
  Workplace place_;
};

// Oracle: the long form.
TEST_F(CommandLine, ShortOptionsAndTheLongOnesAreTheSame) {
  EXPECT_EQ(output("identify -c cantilever.toml"), output("identify --config cantilever.toml"));
  EXPECT_EQ(output("identify -ccantilever.toml"), output("identify --config=cantilever.toml"));
  EXPECT_EQ(output("identify -qc cantilever.toml"), output("identify --quiet --config cantilever.toml"));
  output("modes -o found");
  EXPECT_TRUE(fs::exists(place_.folder() / "found/results.json"));
  EXPECT_EQ(output("-V"), output("--version"));
  EXPECT_EQ(output("modes --version"), output("--version"));
  EXPECT_EQ(output("modes -V"), output("--version"));
  EXPECT_EQ(output("-h"), output("help"));
}

TEST_F(CommandLine, HelpOfACommandIsAskedForInManyWays) {
  const std::string help = output("modes --help");
  EXPECT_EQ(output("help modes"), help);
  EXPECT_EQ(output("modes -h"), help);
  EXPECT_EQ(output("modes --modes many --help"), help);
  EXPECT_THAT(refusal("help mods"), HasSubstr("unknown command 'mods'; did you mean 'modes'?"));
}

TEST_F(CommandLine, OptionsMayStandBeforeTheRecordAndNumbersMayBeNegative) {
  EXPECT_EQ(output("modal --window 2 10 tip_acceleration.csv"),
            output("modal tip_acceleration.csv --window 2 10"));
  EXPECT_THAT(refusal("modal --window -2 -1 tip_acceleration.csv"), HasSubstr("window -2 to -1 s"));
  EXPECT_EQ(output("modes --axial-load -10"), output("modes --axial-load=-10"));
}

TEST_F(CommandLine, BehindTwoDashesNothingIsAnOption) {
  fs::rename(place_.folder() / "tip_acceleration.csv", place_.folder() / "--force");
  EXPECT_THAT(output("inspect -- --force"), HasSubstr("2501 samples"));
}

// Oracle: the same bytes in a file.
TEST_F(CommandLine, ADashIsARecordOnStandardInput) {
  const auto piped = [&](const std::string& words) {
    place_.write("pipe.sh", "cat tip_acceleration.csv | '" BEAMID_COMMAND "' " + words + "\n");
    return place_.run("--version >/dev/null; sh pipe.sh");
  };
  for (const std::string words : {"identify - --config cantilever.toml", "modal -", "inspect -"}) {
    std::string named = words;
    named.replace(named.find('-'), 1, "tip_acceleration.csv");
    std::string expected = output(named);
    for (std::size_t at = 0; (at = expected.find("tip_acceleration.csv", at)) != std::string::npos;)
      expected.replace(at, 20, "standard_input");
    const Outcome outcome = piped(words);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    std::string head = outcome.out.substr(0, outcome.out.find('\n'));
    EXPECT_EQ(head, expected.substr(0, expected.find('\n'))) << words;
    EXPECT_THAT(outcome.out, HasSubstr("standard_input"));
  }
  EXPECT_THAT(piped("identify - --config cantilever.toml --json").out, HasSubstr("\"estimate\": "));
}

TEST_F(CommandLine, SaysWhatWasProbablyMeant) {
  EXPECT_EQ(refusal("mods"), "beamid: unknown command 'mods'; did you mean 'modes'?");
  EXPECT_EQ(refusal("modes --lenght 1"),
            "beamid: modes: unrecognised option '--lenght'; did you mean '--length'?");
  EXPECT_EQ(refusal("list fliters"), "beamid: list: unknown kind 'fliters'; did you mean 'filters'?");
  EXPECT_EQ(refusal("list filters ufk"), "beamid: unknown filter 'ufk'; did you mean 'ukf'?");
  EXPECT_EQ(refusal("compare --config cantilever.toml --filter ufk"),
            "--filter: unknown filter 'ufk'; did you mean 'ukf'?");
  EXPECT_EQ(refusal("identify --config cantilever.toml --estimator bth"),
            "beamid: identify: --estimator is 'bth'; expected filter or both; did you mean 'both'?");
}

TEST_F(CommandLine, AShortListStandsBesideTheSuggestion) {
  EXPECT_THAT(refusal("list smoothers rst"),
              HasSubstr("unknown smoother 'rst'; did you mean 'rts'? known: rts, urts"));
}

TEST_F(CommandLine, WhereNoNameIsNearAllAreListed) {
  EXPECT_THAT(refusal("list filters zzzzzzzz"),
              HasSubstr("unknown filter 'zzzzzzzz'; known: adaptive_ekf, ckf"));
  EXPECT_THAT(refusal("zzzzzzzzzz"),
              HasSubstr("; known: inspect, modal, identify, modes, simulate, compare, report"));
}

TEST_F(CommandLine, SaysWhatAValueIsAndWhatIsExpected) {
  EXPECT_EQ(refusal("modes --modes 1.5"),
            "beamid: modes: --modes is 1.5; expected a whole number from 1 to 1000");
  EXPECT_EQ(refusal("modes --length long"), "beamid: modes: --length is 'long'; expected a number");
  EXPECT_EQ(refusal("modes --length nan"), "beamid: modes: --length is 'nan'; expected a number");
  EXPECT_EQ(refusal("track x --false-alarms 1"),
            "beamid: track: --false-alarms is 1; expected a number above 0 and below 1");
  EXPECT_EQ(refusal("modes --out"), "beamid: modes: option '--out' needs a value: DIR");
  EXPECT_EQ(refusal("modes --out --json"), "beamid: modes: option '--out' needs a value: DIR");
  EXPECT_EQ(refusal("modes --json=yes"), "beamid: modes: option '--json' takes no value");
  EXPECT_EQ(refusal("modes --length 1 --length 2"),
            "beamid: modes: option '--length' is given twice; expected once");
  EXPECT_EQ(
      refusal("modes extra"),
      "beamid: modes: unexpected argument 'extra'; expected: beamid modes [--config FILE] [BEAM OPTIONS] "
      "[--modes K] [--out DIR]");
}

TEST_F(CommandLine, AnIntervalEndsBehindItsStart) {
  for (const std::string command : {"modal tip_acceleration.csv", "identify --config cantilever.toml"})
    EXPECT_THAT(refusal(command + " --window 5 2"),
                HasSubstr(": --window ends at 2, before its start at 5; expected the smaller number first"));
  EXPECT_THAT(refusal("modal tip_acceleration.csv --band 5"),
              HasSubstr("modal: --band needs two numbers: FROM TO"));
}

TEST_F(CommandLine, ANameOnTheCommandLineIsBlamedThere) {
  EXPECT_THAT(refusal("compare --config cantilever.toml --discretisation rk4"),
              testing::StartsWith("--discretisation: unknown discretisation 'rk4'"));
}

// Where results went is no part of what repeats them.
TEST_F(CommandLine, IsRecordedWithoutWhereItsResultsWent) {
  output("modes --modes 3 -o found -q --force");
  const std::string page = contents(place_.folder() / "found/report.html");
  EXPECT_THAT(page, HasSubstr("beamid modes --modes 3<"));
}

// Results are replaced with --force, and nothing else is.
TEST(OutputFolder, IsReplacedOnlyWhereItHoldsResults) {
  Workplace place;
  fs::create_directory(place.folder() / "notes");
  place.write("notes/mine.txt", "keep");
  const Outcome refused = place.run("modes --out notes --force");
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(
      refused.first_error_line(),
      "beamid: output folder 'notes' holds no results.json of beamid; --force replaces only earlier results");
  EXPECT_THAT(place.files(), testing::ElementsAre("notes", "notes/mine.txt"));

  ASSERT_EQ(place.run("modes --modes 3 --out results").code, 0);
  ASSERT_EQ(place.run("modes --modes 2 --out results --force").code, 0);
  EXPECT_EQ(nlohmann::json::parse(contents(place.folder() / "results/results.json")).at("modes").size(), 2);
}

}  // namespace
}  // namespace beamid::apps::words_test
