// Oracles: the reader itself (a key it does not read cannot be refused for its type) and
// docs/configuration.md.
#include "experiments/config/vocabulary.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/read_frame.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::vocabulary_test {
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

/// A parameter whose numbers are in the unit that the key ends with, and a region where the key needs one.
std::vector<std::string> parameter_with(const std::string& key) {
  std::vector<std::string> needed{"quantity = \"bending_stiffness\""};
  if (key == "from_m" || key == "to_m") needed.insert(needed.end(), {"from_m = 0", "to_m = 0.5"});
  for (const ParameterQuantity& quantity : parameter_quantities())
    for (const std::string number : {"guess", "deviation", "lower", "upper"})
      if (key == (quantity.suffix.empty() ? number : number + "_" + quantity.suffix))
        needed = {"quantity = \"" + quantity.name + "\""};
  return needed;
}

/// What a table needs beside the key under test; a key of the same quantity makes way for it.
std::vector<std::string> needed_in(const std::string& table, const std::string& key) {
  const bool member = table == "frame.members", beam = table == "beam" || table == "beam.segments" || member;
  if (table == "record.channels" && key == "distance_m")
    return {"quantity = \"strain\"", "column = 1", "unit = \"m/m\"", "position_m = 0"};
  if (table == "record.channels") return {"quantity = \"force\"", "column = 1", "unit = \"N\""};
  if (table == "record.time") return {"column = 1", "unit = \"s\""};
  if (table == "beam.absorbers") return {"position_m = 0", "mass_kg = 1", "stiffness_n_per_m = 1"};
  if (table == "beam.supports") return {"position_m = 0", "kind = \"pinned\""};
  if (table == "beam.damages") return {"from_m = 0", "to_m = 0.5", "loss = 0.1"};
  if (table == "beam.added_masses") return {"from_m = 0", "to_m = 0.5", "mass_per_length_kg_per_m = 1"};
  if (table == "frame.joints") return {"x_m = 0", "y_m = 0"};
  if (table == "frame.supports") return {"joint = 1", "kind = \"pinned\""};
  if (table.starts_with("frame.") && !member) return {"joint = 1"};
  if (table == "damping.anchors") return {"frequency_hz = 1", "ratio = 0.1"};
  if (table == "parameters") return parameter_with(key);
  if (table == "sensors" && key == "distance_m") return {"quantity = \"strain\"", "position_m = 0"};
  if (table == "sensors" && key == "noise_m_per_m")
    return {"quantity = \"strain\"", "position_m = 0", "distance_m = 1"};
  if (table.starts_with("beam.") && !beam) return {"position_m = 0"};
  if (!beam) return {};
  std::vector<std::string> needed{"length_m = 1"};
  if (member) needed = {"first = 1", "second = 2"};
  const bool round = key.ends_with("diameter_m");
  if (key == "bending_stiffness_n_m2")
    needed.push_back("mass_kg = 1");
  else if (key == "mass_per_length_kg_per_m" || key == "density_kg_per_m3")
    needed.push_back("youngs_modulus_pa = 1");
  else
    needed.insert(needed.end(), {"mass_kg = 1", "youngs_modulus_pa = 1"});
  if (round)
    needed.push_back("diameter_m = 1");
  else
    needed.insert(needed.end(), {"width_m = 1", "height_m = 1"});
  return needed;
}

/// A frame that holds one key, likewise.
std::string frame_with_date(const std::string& table, const std::string& key) {
  std::string text, tested = table == "frame" ? "[frame]\n" : "[[" + table + "]]\n";
  if (table != "frame")
    for (const std::string& line : needed_in(table, key))
      if (!line.starts_with(key + " ")) tested += line + "\n";
  tested += key + " = 2009-01-01\n";
  if (table != "frame.joints")
    text += "[[frame.joints]]\nx_m = 0\ny_m = 0\n[[frame.joints]]\nx_m = 1\ny_m = 0\n";
  if (table != "frame.joints" && table != "frame.members")
    text +=
        "[[frame.members]]\nfirst = 1\nsecond = 2\nbending_stiffness_n_m2 = 1\naxial_stiffness_n = 1\n"
        "mass_kg = 1\n";
  return table == "frame" ? tested + text : text + tested;
}

/// An experiment that holds one key, with a value of a type no key has, beside what makes it valid otherwise.
std::string with_date(const std::string& table, const std::string& key) {
  const std::set<std::string> arrays{"beam.segments",
                                     "beam.bodies",
                                     "beam.supports",
                                     "beam.springs",
                                     "beam.dashpots",
                                     "beam.absorbers",
                                     "beam.damages",
                                     "beam.added_masses",
                                     "damping.anchors",
                                     "sensors",
                                     "frequency_response.pairs",
                                     "reductions",
                                     "filters",
                                     "parameters",
                                     "record.channels",
                                     "record.prepare"};
  if (table.starts_with("frame")) return frame_with_date(table, key);
  std::string text;
  if (table.empty()) text += key + " = 2009-01-01\n";
  if (table != "beam" && table != "beam.segments")
    text += "[beam]\nlength_m = 1\nmass_kg = 1\nbending_stiffness_n_m2 = 1\n";
  if (table.empty()) return text;
  text += arrays.contains(table) ? "[[" + table + "]]\n" : "[" + table + "]\n";
  for (const std::string& line : needed_in(table, key))
    if (!line.starts_with(key + " ")) text += line + "\n";
  return text + key + " = 2009-01-01\n";
}

TEST(Vocabulary, HoldsNoKeyThatIsNotRead) {
  for (const std::string& path : known_keys()) {
    const std::size_t dot = path.rfind('.');
    const std::string table = dot == std::string::npos ? "" : path.substr(0, dot), key = path.substr(dot + 1);
    const TemporaryFile file("date.toml", with_date(table, key));
    std::string message = input_error_of(file, [&] {
      if (table.starts_with("frame"))
        read_frame(file.path());
      else
        read_experiment(file.path());
    });
    for (std::size_t at; (at = message.find("[1]")) != std::string::npos;) message.erase(at, 3);
    EXPECT_NE(message.find(": " + path + " is a date or time; expected "), std::string::npos)
        << path << ": " << message << "\n"
        << with_date(table, key);
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

/// The document's examples, in its order.
std::vector<std::string> examples() {
  const std::string text = document(), fence = "```toml\n";
  std::vector<std::string> found;
  for (std::size_t at = 0; (at = text.find(fence, at)) != std::string::npos;) {
    at += fence.size();
    found.push_back(text.substr(at, text.find("```", at) - at));
  }
  return found;
}

TEST(ConfigurationDocument, HoldsExamplesThatAreValid) {
  ASSERT_EQ(examples().size(), 3u);
  const TemporaryFile record("record.toml", examples()[0]), beam("beam.toml", examples()[1]);
  const Experiment with_record = read_experiment(record.path()),
                   with_everything = read_experiment(beam.path());
  EXPECT_EQ(with_record.record_file, "massa1_test1-1.txt");
  EXPECT_DOUBLE_EQ(with_record.beam.tip_mass(), 1.437 + 0.054);
  EXPECT_EQ(with_everything.beam.segments.size(), 3u);
  EXPECT_EQ(with_everything.sensors.size(), 2u);
  EXPECT_EQ(read_frame(TomlTable::parse(examples()[2], "frame.toml")).frame.members.size(), 4u);
}

TEST(ConfigurationDocument,
     ShowsEveryKeyInItsExamples) {  // also what they leave at its default, as a comment
  const std::string shown = examples().at(0) + examples().at(1) + examples().at(2);
  for (const std::string& key : known_keys()) {
    const std::string name = key.substr(key.rfind('.') + 1);
    EXPECT_NE(shown.find(name + " ="), std::string::npos) << "the examples do not show " << key;
  }
}

}  // namespace
}  // namespace beamid::experiments::vocabulary_test
