// docs/configuration.md and the program say the same. Oracle: the keys that the readers have.
// BEAMID_UPDATE_GOLDEN=1 experiments_tests --gtest_filter='ConfigurationPage.*' writes the tables of the page
// anew.
#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "experiments/config/key_tables.hpp"
#include "experiments/config/read_experiment.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::configuration_page_test {
namespace {

using testing::HasSubstr;

const std::string page_file = BEAMID_SOURCE_DIR "/docs/configuration.md";

std::string page() {
  std::ifstream stream(page_file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(ConfigurationPage, HasTheTablesOfTheProgram) {
  const std::string current = with_current_keys(page());
  if (std::getenv("BEAMID_UPDATE_GOLDEN") != nullptr) std::ofstream(page_file) << current;
  EXPECT_EQ(lines_of(page()), lines_of(current));
}

TEST(ConfigurationPage, HasAHeadingForEveryTable) {
  const std::string text = page();
  for (const KeyTable* table : key_tables())
    EXPECT_THAT(text, HasSubstr(table->name().empty() ? "### The file itself\n"
                                                      : "### `" + heading_of(*table) + "`\n"));
}

TEST(ConfigurationPage, GainsANewKeyLosesAnOldOneAndKeepsItsText) {
  const std::string written = with_current_keys(
      "### `[compare]`\n\nBefore.\n\n| key | type |\n|---|---|\n| `gone` | number |\n| `passes` | old "
      "|\n\nAfter.\n");
  EXPECT_THAT(written,
              HasSubstr("### `[compare]`\n\nBefore.\n\n| key | type |\n|---|---|\n| `passes` | whole "
                        "number, 1 to 20 |  | `3` |"));
  EXPECT_THAT(written, HasSubstr("|\n| `discretisations` | texts |"));
  EXPECT_THAT(written, HasSubstr("|\n\nAfter.\n"));
  EXPECT_THAT(written, testing::Not(HasSubstr("gone")));
  EXPECT_THAT(with_current_keys("### `[compare]`\n\n| key | type |\n|---|---|\n\nAfter.\n"),
              HasSubstr("|---|---|\n| `discretisations` | texts |"));
}

TEST(ConfigurationPage, SaysOfEveryKeyWhatItMeansByAnExampleThatMayStandInAFile) {
  for (const KeyTable* table : key_tables())
    for (const Key& key : table->keys()) {
      if (key.is_table()) continue;
      EXPECT_FALSE(key.meaning.empty()) << table->name() << "." << key.name;
      const std::string text = "[table]\n" + key.name + " = " + key.example + "\n";
      try {
        table->check(TomlTable::parse(text, "a.toml").table("table"));
      } catch (const InputError& error) {
        ADD_FAILURE() << text << error.what();
      }
    }
}

/// The page's examples, in its order.
std::vector<std::string> examples() {
  const std::string text = page(), fence = "```toml\n";
  std::vector<std::string> found;
  for (std::size_t at = 0; (at = text.find(fence, at)) != std::string::npos;) {
    at += fence.size();
    found.push_back(text.substr(at, text.find("```", at) - at));
  }
  return found;
}

TEST(ConfigurationPage, HoldsExamplesThatAreValid) {
  ASSERT_EQ(examples().size(), 6u);
  const TemporaryFile record("record.toml", examples()[0]), beam("beam.toml", examples()[1]);
  const Experiment with_record = read_experiment(record.path()),
                   with_everything = read_experiment(beam.path());
  EXPECT_EQ(with_record.record_file, "massa1_test1-1.txt");
  EXPECT_DOUBLE_EQ(with_record.structure.beam().tip_mass(), 1.437 + 0.054);
  EXPECT_EQ(with_everything.structure.beam().segments.size(), 3u);
  EXPECT_EQ(with_everything.sensors.size(), 2u);
  const Experiment frame = read_experiment(TomlTable::parse(examples()[3], "frame.toml"));
  EXPECT_EQ(frame.structure.frame()->members.size(), 4u);
  const Experiment in_space = read_experiment(TomlTable::parse(examples()[4], "space_frame.toml"));
  EXPECT_EQ(in_space.structure.space_frame()->members.size(), 9u);
  EXPECT_NO_THROW(check_values(TomlTable::parse(examples()[5], "system.toml")));  // its matrices are not here
  const TemporaryFile chain("chain.toml", examples()[2]);
  EXPECT_EQ(read_experiment(chain.path()).structure.beam().segments.size(), 3u);
}

TEST(ConfigurationPage, ShowsEveryKeyInItsExamples) {  // also what they leave at its default, as a comment
  std::string shown;
  for (const std::string& example : examples()) shown += example;
  for (const KeyTable* table : key_tables())
    for (const Key& key : table->keys())
      if (!key.is_table()) {
        EXPECT_THAT(shown, HasSubstr(key.name + " =")) << "the examples do not show " << key.name;
      }
}

}  // namespace
}  // namespace beamid::experiments::configuration_page_test
