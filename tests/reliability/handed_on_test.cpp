// What names of channels, sensors, titles and files bring along goes no further than the text that they are:
// pages, pictures, plot scripts, tables, the terminal, names of files. Oracles: the folder's listing (a
// command that was run leaves the file OWNED), the bytes written.
#include <gmock/gmock.h>

#include "tests/reliability/shell.hpp"

namespace beamid::reliability::handed_on_test {
namespace {

using apps::contents, apps::Outcome, testing::AnyOf, testing::Contains, testing::EndsWith, testing::HasSubstr,
    testing::Not;
namespace fs = std::filesystem;

constexpr const char* hostile[] = {"`touch OWNED`",
                                   "$(touch OWNED)",
                                   "'.system('touch OWNED').'",
                                   "\".system(\"touch OWNED\").\"",
                                   "x\\",
                                   "\\\"; system 'touch OWNED' #",
                                   "@OWNED {/Symbol {",
                                   "%s%n%x ${HOME} !touch OWNED",
                                   "<script>touch('OWNED')</script>",
                                   "<img src=x onerror=alert(1)>",
                                   "]]><!-- &lt;b&gt; &#60;i&#62; \"><svg onload=a>",
                                   "../../../OWNED",
                                   "/tmp/OWNED",
                                   "=cmd|'/c calc'!A1"};

/// A page up to its last script, which the policy in its head names by a hash; all of it where it has none.
std::string without_own_script(const std::string& page) {
  const std::size_t own = page.rfind("<script>\n");
  return own == std::string::npos ? page : page.substr(0, own);
}

class HandedOn : public testing::TestWithParam<int> {
 protected:
  HandedOn() : name_(hostile[GetParam()]) { copy_tutorial(place_); }

  std::string quoted(const std::string& text, const std::string& escape) const {
    std::string result;
    for (const char c : text)
      (result += c == '"' ? escape : c == '\\' && escape == "\\\"" ? "\\\\" : std::string(1, c));
    return '"' + result + '"';
  }

  /// Below `folder` nothing was run, and nothing of the name is markup.
  void expect_harmless(const std::string& folder) const {
    EXPECT_TRUE(fs::exists(place_.folder() / folder / "report.html"));
    int pictures = 0;
    for (const std::string& file : place_.files()) {
      EXPECT_THAT(fs::path(file).filename().string(), Not(HasSubstr("OWNED"))) << file;
      if (!file.starts_with(folder + "/")) continue;
      pictures += file.ends_with(".svg");
      std::string text = contents(place_.folder() / file);
      if (file == folder + "/report.html") text = without_own_script(text);
      if (!file.ends_with(".html") && !file.ends_with(".svg")) continue;
      EXPECT_THAT(text, Not(AnyOf(HasSubstr("<script"), HasSubstr("<img src=x"), HasSubstr("<svg onload"),
                                  HasSubstr("<!-- &lt;b"), HasSubstr("<i>"))))
          << file;
    }
    EXPECT_GT(pictures, 0);
    EXPECT_FALSE(fs::exists(place_.folder().parent_path() / "OWNED"));
    EXPECT_FALSE(fs::exists("/tmp/OWNED"));
  }

  std::string name_;
  apps::Workplace place_;
};

TEST_P(HandedOn, NamesOfChannelsAreText) {
  const std::string text = contents(place_.folder() / "tip_acceleration.csv");
  place_.write("named.csv", "time_s," + quoted(name_, "\"\"") + text.substr(text.find('\n')));
  const Outcome outcome = place_.run(
      "modal named.csv --time 1 --column 2 --quantity acceleration --unit m/s2 --window 2 10 --out r");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  expect_harmless("r");
}

TEST_P(HandedOn, TitlesAndNamesOfSensorsAreText) {
  std::string rig = contents(apps::source("docs/tutorials/13_sweeps/rig.toml"));
  rig.replace(rig.find("[[sensors]]"), 11, "[[sensors]]\nname = " + quoted(name_, "\\\""));
  rig.replace(0, rig.find('\n'), "title = " + quoted(name_, "\\\""));
  place_.write("rig.toml", rig);
  const Outcome outcome = place_.run("simulate --config rig.toml --out r");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  expect_harmless("r");
}

INSTANTIATE_TEST_SUITE_P(Name, HandedOn, testing::Range(0, static_cast<int>(std::size(hostile))));

// Its one script is the one whose hash the policy names.
TEST(Page, OpensOfflineWithoutAnotherScript) {
  const apps::Workplace place;
  ASSERT_EQ(place.run("modes --out r").code, 0);
  const std::string page = contents(place.folder() / "r/report.html");
  EXPECT_THAT(page, HasSubstr("content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'; "
                              "script-src 'sha256-"));
  EXPECT_EQ(page.find("<script"), page.rfind("<script"));
  EXPECT_THAT(page, HasSubstr("<script>\n"));
  for (const char* from_elsewhere :
       {"http://", "https://", "<script ", "<link", "<iframe", "javascript:", "url(\"", "url(h"})
    EXPECT_THAT(page, Not(HasSubstr(from_elsewhere)));
}

}  // namespace
}  // namespace beamid::reliability::handed_on_test
