// Oracles: the files themselves; what is kept of one, written as a file and read again, keeps the same.
#include "experiments/config/description.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/structure_description.hpp"
#include "tests/apps/run_command.hpp"

namespace beamid::experiments::effective_keys_test {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

// A value as TOML has it in a line; JSON's numbers, texts and arrays are TOML's.
std::string in_line(const Json& value) {
  if (!value.is_object()) {
    if (!value.is_array()) return value.dump();
    std::string text;
    for (const Json& one : value) text += (text.empty() ? "" : ",\n") + in_line(one);
    return "[" + text + "]";
  }
  std::string text;
  for (const auto& [key, inner] : value.items())
    text += (text.empty() ? "" : ", ") + key + " = " + in_line(inner);
  return "{" + text + "}";
}

std::string in_lines(const std::string& heading, const Json& table) {
  std::string text = heading + "\n";
  for (const auto& [key, value] : table.items()) text += key + " = " + in_line(value) + "\n";
  return text;
}

std::string as_toml(const Json& keys) {
  std::string text, tables;
  for (const auto& [key, value] : keys.items())
    if (value.is_object())
      tables += in_lines("[" + key + "]", value);
    else if (value.is_array())
      for (const Json& one : value) tables += in_lines("[[" + key + "]]", one);
    else
      text += key + " = " + value.dump() + "\n";
  return text + tables;
}

Json keys_of(const std::string& text, const std::vector<std::string>& also = {}) {
  return effective_keys(TomlTable::parse(text, "a.toml"), also);
}

TEST(EffectiveKeys, OfEveryShippedFileAreTheSameExperiment) {
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(apps::source("docs/tutorials"))) {
    if (entry.path().extension() != ".toml") continue;
    const TomlTable root = TomlTable::read(entry.path());
    if (!root.contains("beam") && !root.contains("frame") && !root.contains("chain") &&
        !root.contains("space_frame"))
      continue;
    if (entry.path().string().find("of_your_own") != std::string::npos) continue;  // names that are not ours
    const std::vector<std::string> also{"excitation", "simulation", "frequency_response",
                                        "filter",     "compare",    "identifiability",
                                        "model",      "reduction",  "record"};
    const Experiment one = read_experiment(root);
    const std::string text = as_toml(effective_keys(one, also));
    const Experiment other = read_experiment(TomlTable::parse(text, entry.path().string()));
    EXPECT_EQ(nlohmann::json(effective_keys(other)), nlohmann::json(effective_keys(one, also)))
        << entry.path();
    EXPECT_EQ(describe(other.structure, other.elements), describe(one.structure, one.elements)) << text;
    ++files;
  }
  EXPECT_GT(files, 35);
}

TEST(EffectiveKeys, AreWhatIsGivenAndTheDefaultsOfTablesThatStandOnce) {
  const Json keys = keys_of(
      "[beam]\nlength_m = 2\nbending_stiffness_n_m2 = 10\nmass_kg = 1\n[[beam.bodies]]\nposition_m = 1\n"
      "mass_kg = 3\n");
  EXPECT_EQ(keys["beam"]["length_m"], 2);
  EXPECT_EQ(keys["beam"]["elements"], 40);
  EXPECT_EQ(keys["beam"]["support"], "clamped-free");
  EXPECT_EQ(keys["beam"]["bodies"][0], Json::parse(R"({"position_m": 1, "mass_kg": 3})"));
  EXPECT_FALSE(keys.contains("simulation"));
}

TEST(EffectiveKeys, HoldTablesThatWereAskedForThoughTheFileHasNone) {
  const Json keys = keys_of("title = \"a\"\n", {"simulation", "excitation"});
  EXPECT_EQ(keys["simulation"]["steps_per_sample"], 1);
  EXPECT_EQ(keys["excitation"]["kind"], "release");
}

TEST(EffectiveKeys, HaveNoDefaultThatIsOfNoUseBesideWhatIsGiven) {
  const Json impulse = keys_of("[excitation]\nkind = \"impulse\"\nmomentum_n_s = 1\n")["excitation"];
  EXPECT_EQ(impulse, Json::parse(R"({"kind": "impulse", "momentum_n_s": 1, "duration_s": 0.0})"));
}

TEST(EffectiveKeys, AreThoseOfTheCommandLineWhereItSetsThem) {
  const TomlTable root = TomlTable::parse("[beam]\nmass_kg = 1\n", "a.toml",
                                          {{"beam", "density_kg_per_m3", 7850.0, "--density", {"mass_kg"}}});
  const Json beam = effective_keys(root)["beam"];
  EXPECT_EQ(beam["density_kg_per_m3"], 7850);
  EXPECT_FALSE(beam.contains("mass_kg"));
}

TEST(EffectiveKeys, KeepOptionsOfAMethod) {
  EXPECT_EQ(keys_of("[filter]\nmethod = \"ukf\"\nalpha = 0.5\n")["filter"]["alpha"], 0.5);
}

}  // namespace
}  // namespace beamid::experiments::effective_keys_test
