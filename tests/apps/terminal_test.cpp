// Text as wide as the terminal, its colours, and what is said while work goes on. Oracle: a terminal of the
// kernel's, of a width that the test chooses.
#include "tests/apps/terminal.hpp"

#include <gmock/gmock.h>

#include <sstream>

#include "experiments/results/text.hpp"

namespace beamid::apps::terminal_test {
namespace {

using testing::ContainsRegex, testing::HasSubstr, testing::Not;

constexpr const char* red = "\033[1;31m";

std::size_t widest_line(const std::string& text) {
  std::istringstream lines(text);
  std::size_t width = 0;
  for (std::string line; std::getline(lines, line);) width = std::max(width, experiments::width_of(line));
  return width;
}

class Terminal : public testing::Test {
 protected:
  Terminal() {
    fs::copy(source("docs/tutorials/02_identify_a_record"), place_.folder(), fs::copy_options::recursive);
    std::string text = contents(place_.folder() / "cantilever.toml");
    place_.write("diverges.toml",
                 text + "\n[prior]\nstiffness_n_per_m = 400\nstiffness_deviation_n_per_m = 1e-3\n");
  }
  Workplace place_;
};

TEST_F(Terminal, TextIsAsWideAsItIs) {
  for (const auto columns : std::initializer_list<unsigned short>{60, 80, 132})
    for (const char* words : {"modes --no-progress", "--help", "sweep --help", "steps --help", "list filters",
                              "identify --config cantilever.toml --no-progress"}) {
      const std::string seen = seen_in_terminal(place_, words, columns);
      EXPECT_LE(widest_line(seen), columns) << words << "\n" << seen;
      EXPECT_THAT(seen, HasSubstr("a")) << words;
    }
  EXPECT_GT(widest_line(seen_in_terminal(place_, "modes --no-progress", 132)), 100u);
}

// Examples may be copied as they stand: a shell joins lines that end in a backslash.
TEST_F(Terminal, ExamplesOfHelpAreContinuedBehindABackslash) {
  EXPECT_THAT(seen_in_terminal(place_, "steps --help", 80),
              HasSubstr("  beamid steps --config cantilever.toml --discretisation forward_euler \\\n"
                        "      --discretisation runge_kutta_2\n"));
}

TEST_F(Terminal, ColumnsOfTheEnvironmentComeFirst) {
  const std::string narrow = seen_in_terminal(place_, "modes --no-progress", 132, "COLUMNS=70");
  EXPECT_LE(widest_line(narrow), 70u);
}

TEST_F(Terminal, ElsewhereTextIs100ColumnsWide) {
  const std::string piped = place_.run("modes", "COLUMNS=70 TERM=xterm").out;
  EXPECT_LE(widest_line(piped), 100u);
  EXPECT_GT(widest_line(piped), 70u);
}

TEST_F(Terminal, VerdictsStandInBoldRed) {
  const std::string words = "identify --config diverges.toml --no-progress";
  EXPECT_THAT(seen_in_terminal(place_, words, 100), HasSubstr(std::string(red) + "DIVERGED\033[0m"));
  for (const char* none : {"NO_COLOR=1 TERM=xterm", "TERM=dumb"}) {
    const std::string seen = seen_in_terminal(place_, words, 100, none);
    EXPECT_THAT(seen, HasSubstr("DIVERGED"));
    EXPECT_THAT(seen, Not(HasSubstr("\033"))) << none;
  }
  const Outcome piped = place_.run(words, "TERM=xterm");
  EXPECT_EQ(piped.code, 3);
  EXPECT_THAT(piped.out, HasSubstr("DIVERGED"));
  EXPECT_THAT(piped.out + piped.err, Not(HasSubstr("\033")));
}

TEST_F(Terminal, LongWorkSaysHowFarItIsAndHowLongItTakes) {
  const std::string seen =
      seen_in_terminal(place_, "efficiency --filter ekf --damping-ratio 0.1 --runs 300", 100);
  EXPECT_THAT(seen, HasSubstr("\r\033[Kekf, lengthening passes, damping ratio 10 %: 0 of 600 runs ..."));
  EXPECT_THAT(seen, ContainsRegex("of 600 runs, [0-9.e+]+ per second, [0-9]+ s remaining"));
}

TEST_F(Terminal, ProgressIsSilencedByAnOption) {
  for (const char* silent : {" --no-progress", " --quiet", " -q"})
    EXPECT_THAT(seen_in_terminal(place_, std::string("modes") + silent, 100), Not(HasSubstr("assembling")));
  EXPECT_THAT(seen_in_terminal(place_, "modes", 100), HasSubstr("assembling ..."));
}

TEST_F(Terminal, VerboseSaysWhatIsDoneToFilesToo) {
  EXPECT_THAT(place_.run("modes -v").err, ContainsRegex("^ +[0-9.]+ s  assembling\n"));
  EXPECT_EQ(place_.run("modes").err, "");
}

TEST_F(Terminal, QuietPrintsTheFirstTableAndWhatStandsAbove) {
  const std::string all = place_.run("identify --config cantilever.toml").out,
                    brief = place_.run("identify --config cantilever.toml --quiet").out;
  EXPECT_THAT(brief, HasSubstr("damping ratio [%]"));
  EXPECT_THAT(all, testing::StartsWith(brief));
  EXPECT_THAT(brief, Not(HasSubstr("Innovations")));
}

}  // namespace
}  // namespace beamid::apps::terminal_test
