// The keys of an experiment file as a whole. Oracles: files with one mistake each; the rules of
// docs/configuration.md, by hand.
#include "experiments/config/key_tables.hpp"

#include <gmock/gmock.h>

#include <set>

#include "experiments/config/read_experiment.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::key_tables_test {
namespace {

using testing::HasSubstr;
using testing::UnorderedElementsAre;

/// A file that holds one line of one table.
std::string file_with(const KeyTable& table, const std::string& line) {
  return table.name().empty() ? line : heading_of(table) + "\n" + line;
}

std::string refusal(const std::string& text) {
  try {
    read_experiment(TomlTable::parse(text, "a.toml"));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(KeyTables, HoldATableForEveryKeyThatIsOne) {
  for (const KeyTable* table : key_tables())
    for (const Key& key : table->keys())
      if (key.is_table()) {
        EXPECT_NE(find_key_table(table->name().empty() ? key.name : table->name() + "." + key.name), nullptr)
            << table->name() << " " << key.name;
      }
}

TEST(KeyTables, HoldEachKeyOfATableOnce) {
  std::set<std::string> names;
  for (const KeyTable* table : key_tables()) {
    EXPECT_TRUE(names.insert("[" + table->name() + "]").second) << table->name();
    for (const Key& key : table->keys())
      EXPECT_TRUE(names.insert(table->name() + "." + key.name).second) << table->name() << "." << key.name;
  }
}

// No key has a date.
TEST(KeyTables, RefuseAValueOfAWrongTypeWhateverElseTheFileLacks) {
  for (const KeyTable* table : key_tables())
    for (const Key& key : table->keys()) {
      const std::string path = table->name().empty() ? key.name : table->name() + "." + key.name;
      if (path == "frame") continue;  // refused first, beside a beam that is missing
      std::string message = refusal(file_with(*table, key.name + " = 2009-01-01\n"));
      for (std::size_t at; (at = message.find("[1]")) != std::string::npos;) message.erase(at, 3);
      EXPECT_THAT(message, HasSubstr(": " + path + " is a date or time; expected ")) << path;
    }
}

TEST(KeyTables, OfferTheNearestKeyInsteadOfAMisspeltOne) {
  for (const KeyTable* table : key_tables()) {
    if (table->has_options() || table->name().empty()) continue;
    const std::string& key = table->keys().front().name;
    EXPECT_THAT(
        refusal(file_with(*table, key + "x = 1\n")),
        HasSubstr("unknown key '" + key + "x' in " + table->name() + "; did you mean '" + key + "'?"));
  }
}

TEST(KeyTables, KnowWhichKeysGiveTheSameQuantity) {
  const KeyTable& beam = *find_key_table("beam");
  EXPECT_THAT(beam.rivals("mass_kg"), UnorderedElementsAre("density_kg_per_m3", "mass_per_length_kg_per_m"));
  EXPECT_THAT(beam.rivals("width_m"), UnorderedElementsAre("diameter_m", "end_diameter_m"));
  EXPECT_THAT(beam.rivals("diameter_m"),
              UnorderedElementsAre("width_m", "height_m", "end_width_m", "end_height_m"));
  EXPECT_THAT(beam.rivals("youngs_modulus_pa"), UnorderedElementsAre("bending_stiffness_n_m2"));
  EXPECT_THAT(beam.rivals("tip_mass_kg"), UnorderedElementsAre());
  EXPECT_THAT(find_key_table("damping")->rivals("ratio"),
              UnorderedElementsAre("law", "ratios", "anchors", "loss_factor"));
  EXPECT_THAT(find_key_table("damping")->rivals("loss_factor"),  // whose law stays
              UnorderedElementsAre("ratio", "ratios", "anchors"));
}

TEST(KeyTables, AreFoundByThePathOfAKey) {
  EXPECT_EQ(find_key("beam.springs.cubic_n_per_m3")->range.least, any_number.least);
  EXPECT_EQ(find_key("title")->type, Key::Type::text);
  EXPECT_EQ(find_key("beam.colour"), nullptr);
  EXPECT_EQ(find_key("beem.length_m"), nullptr);
}

}  // namespace
}  // namespace beamid::experiments::key_tables_test
