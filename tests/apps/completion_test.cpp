// Completion by bash itself, and manual pages as man reads them.
#include <gmock/gmock.h>

#include <regex>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::completion_test {
namespace {

using testing::Contains, testing::HasSubstr, testing::Not, testing::StartsWith;

/// What bash offers for the last of the words. Oracle: bash.
std::vector<std::string> offered(const std::vector<std::string>& words) {
  Workplace place;
  std::string line = "COMP_WORDS=(";
  for (const std::string& word : words) line += "'" + word + "' ";
  place.write("ask.bash", "source completion.bash\n" + line + ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n" +
                              "_beamid\nprintf '%s\\n' \"${COMPREPLY[@]}\" >offered\n");
  EXPECT_EQ(place.run("completion bash >completion.bash; bash ask.bash").err, "");
  std::istringstream lines(contents(place.folder() / "offered"));
  std::vector<std::string> found;
  for (std::string name; std::getline(lines, name);) found.push_back(name);
  return found;
}

TEST(Completion, OffersCommands) {
  EXPECT_THAT(offered({"beamid", "mod"}), testing::UnorderedElementsAre("modes", "modal"));
  EXPECT_THAT(offered({"beamid", "help", "tra"}), testing::ElementsAre("track"));
}

TEST(Completion, OffersOptionsOfTheCommandOnly) {
  EXPECT_THAT(offered({"beamid", "modes", "--tip"}),
              testing::UnorderedElementsAre("--tip-mass", "--tip-inertia", "--tip-eccentricity"));
  EXPECT_THAT(offered({"beamid", "list", "--"}), Not(Contains("--out")));
}

TEST(Completion, OffersNamesThatAnOptionTakes) {
  EXPECT_THAT(offered({"beamid", "compare", "--filter", "u"}), testing::ElementsAre("ukf"));
  EXPECT_THAT(offered({"beamid", "compare", "--filter", "=", "u"}), testing::ElementsAre("ukf"));
  EXPECT_THAT(offered({"beamid", "identify", "--smoother", ""}),
              testing::UnorderedElementsAre("rts", "urts"));
  EXPECT_THAT(offered({"beamid", "list", "fil"}), testing::ElementsAre("filters"));
}

TEST(Completion, LeavesFilesToTheShell) {
  EXPECT_THAT(offered({"beamid", "identify", "rec"}), testing::ElementsAre(""));
  EXPECT_THAT(offered({"beamid", "modes", "--config", ""}), testing::ElementsAre(""));
}

TEST(Completion, KnowsBashOnly) {
  EXPECT_THAT(Workplace().run("completion fish").first_error_line(), HasSubstr("known: bash"));
}

class ManualPage : public testing::TestWithParam<const char*> {};

// Oracle: man(7): a title, sections in their order, no request that a text began by accident.
TEST_P(ManualPage, HasTheSectionsOfAManualPage) {
  const Outcome outcome = Workplace().run(std::string("man ") + GetParam());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, StartsWith(".TH BEAMID"));
  std::size_t at = 0;
  for (const char* section : {".SH NAME", ".SH SYNOPSIS", ".SH OPTIONS", ".SH EXAMPLES", ".SH EXIT STATUS"}) {
    at = outcome.out.find(std::string("\n") + section + "\n", at);
    ASSERT_NE(at, std::string::npos) << section;
  }
  std::istringstream lines(outcome.out);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(".") || line.starts_with("'")) {
      EXPECT_TRUE(std::regex_search(line, std::regex("^\\.(TH|SH|SS|TP|B|BR|nf|fi)( |$)"))) << line;
    }
}

// Oracle: --help.
TEST_P(ManualPage, NamesEveryOptionOfTheHelp) {
  const std::string help = Workplace().run(std::string(GetParam()) + " --help").out;
  std::string page = Workplace().run(std::string("man ") + GetParam()).out;
  page = std::regex_replace(page, std::regex("\\\\-"), "-");
  const std::regex option("\n {2}(-[a-zA-Z], |    )(--[a-z-]+)");
  int count = 0;
  for (std::sregex_iterator found(help.begin(), help.end(), option), end; found != end; ++found, ++count)
    EXPECT_THAT(page, HasSubstr("\\fB" + (*found)[2].str() + "\\fR")) << (*found)[2];
  EXPECT_GE(count, 2);
}

INSTANTIATE_TEST_SUITE_P(Commands, ManualPage,
                         testing::Values("modes", "identify", "sweep", "stream", "list", "paper"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(ManualPage, OfIdentifyTellsItsExitCodes) {
  for (const char* words : {"man identify", "identify --help"}) {
    std::string text = Workplace().run(words).out;
    EXPECT_TRUE(std::regex_search(text, std::regex("\n(\\.B 3\n|  3 +)no estimate to rely on"))) << text;
  }
}

TEST(ManualPage, OfBeamidNamesTheCommands) {
  const std::string page = Workplace().run("man").out;
  for (const char* command : {"modes", "identify", "sweep", "paper"})
    EXPECT_THAT(page, HasSubstr(std::string(".BR beamid\\-") + command + " (1)"));
}

TEST(ManualPage, IsWrittenForEveryCommand) {
  const Workplace place;
  EXPECT_EQ(place.run("man --all man1").code, 0);
  EXPECT_THAT(place.files(), Contains("man1/beamid.1"));
  EXPECT_THAT(place.files(), Contains("man1/beamid-identify.1"));
  EXPECT_THAT(place.files(), Not(Contains("man1/beamid-man.1")));
}

}  // namespace
}  // namespace beamid::apps::completion_test
