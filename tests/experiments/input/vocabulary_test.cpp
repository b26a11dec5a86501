// Oracles: the reader itself (a key it does not read cannot be refused for its type) and
// docs/configuration.md.
#include "experiments/input/vocabulary.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "experiments/input/read_experiment.hpp"
#include "tests/experiments/input/temporary_file.hpp"

namespace beamid::experiments {
namespace {

std::string document() {
  std::ifstream stream(BEAMID_SOURCE_DIR "/docs/configuration.md");
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// Every key with a table in front, "beam.length_m"; tables themselves are left out.
std::set<std::string> known_keys() {
  std::set<std::string> keys, tables;
  for (const TableVocabulary& table : vocabulary()) tables.insert(table.table);
  for (const TableVocabulary& table : vocabulary())
    for (const std::string& key : table.keys) {
      const std::string path = table.table.empty() ? key : table.table + "." + key;
      if (!tables.contains(path)) keys.insert(path);
    }
  return keys;
}

/// An experiment that holds one key, with a value of a type no key has, beside what makes it valid otherwise.
std::string with_date(const std::string& path) {
  const std::map<std::string, std::string> needed{{"beam.length_m", "1"},
                                                  {"beam.mass_kg", "1"},
                                                  {"beam.youngs_modulus_pa", "1"},
                                                  {"beam.width_m", "1"},
                                                  {"beam.height_m", "1"}};
  const std::map<std::string, std::string> instead{{"beam.bending_stiffness_n_m2", "beam.youngs_modulus_pa"},
                                                   {"beam.mass_per_length_kg_per_m", "beam.mass_kg"},
                                                   {"beam.density_kg_per_m3", "beam.mass_kg"}};
  const std::string channel = "record.channels.", date = " = 2009-01-01\n";
  if (path.starts_with(channel)) {
    std::string text =
        "beam = {length_m = 1, mass_kg = 1, bending_stiffness_n_m2 = 1}\n[[record.channels]]\n";
    for (const std::string key : {"quantity = \"force\"", "column = 1", "unit = \"N\""})
      text += key.starts_with(path.substr(channel.size())) ? path.substr(channel.size()) + date : key + "\n";
    return text;
  }
  std::string text = path + date;
  for (const auto& [key, value] : needed)
    if (key != path && (!instead.contains(path) || instead.at(path) != key))
      text += key + " = " + value + "\n";
  if (path == "record.time.unit") text += "record.time.column = 1\n";
  return text;
}

TEST(Vocabulary, HoldsNoKeyThatIsNotRead) {
  for (const std::string& key : known_keys()) {
    const TemporaryFile file("date.toml", with_date(key));
    std::string named = key;
    if (const std::size_t at = named.find("channels."); at != std::string::npos) named.insert(at + 8, "[1]");
    const std::string message = input_error_of(file, [&] { read_experiment(file.path()); });
    EXPECT_NE(message.find(": " + named + " is a date or time; expected "), std::string::npos)
        << key << ": " << message;
  }
}

/// Keys stand in table rows "| `key` |..." below headings "### `[table]`" or "### `[[array.of_tables]]`".
std::set<std::string> documented_keys() {
  std::set<std::string> keys;
  std::string table, line;
  std::stringstream text(document());
  while (std::getline(text, line)) {
    const std::size_t first = line.find('`'), last = line.find('`', first + 1);
    const bool quoted = last != std::string::npos;
    std::string word = quoted ? line.substr(first + 1, last - first - 1) : "";
    if (line.starts_with("#")) {
      std::erase_if(word, [](char letter) { return letter == '[' || letter == ']'; });
      table = word.empty() ? "" : word + ".";
    } else if (quoted && first == 2 && line.starts_with("| ")) {
      keys.insert(table + word);
    }
  }
  return keys;
}

TEST(Vocabulary, IsTheDocumentsToTheLastKey) {
  EXPECT_EQ(documented_keys(), known_keys());
}

TEST(ConfigurationDocument, HoldsAnExampleThatIsValid) {
  const std::string text = document(), fence = "```toml\n";
  const std::size_t begin = text.find(fence);
  ASSERT_NE(begin, std::string::npos);
  const std::string example =
      text.substr(begin + fence.size(), text.find("```", begin + 3) - begin - fence.size());
  const TemporaryFile file("example.toml", example);
  const Experiment experiment = read_experiment(file.path());
  EXPECT_EQ(experiment.record_file, "massa1_test1-1.txt");
  EXPECT_DOUBLE_EQ(experiment.beam.tip_mass(), 1.437 + 0.054);
  for (const std::string& key : known_keys()) {  // also what it leaves at its default, as a comment
    const std::string name = key.substr(key.rfind('.') + 1);
    EXPECT_NE(example.find(name + " ="), std::string::npos) << "the example does not show " << key;
  }
}

}  // namespace
}  // namespace beamid::experiments
