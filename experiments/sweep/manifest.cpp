#include "experiments/sweep/manifest.hpp"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>

#include "experiments/config/read_experiment.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/json_file.hpp"
#include "experiments/text/text_file.hpp"
#include "experiments/text/words.hpp"
#include "filters/batch.hpp"

namespace beamid::experiments {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

/// Of a file that is not there too: cases that need it say so.
std::string hash_of_file(const fs::path& file) {
  if (!fs::exists(file)) return "not there";
  return hash_of(read_bytes(file, "a file for the cases of a sweep"));
}

/// Files that an experiment file names, in its own words, with their hashes. One that cannot be read names
/// none, and no case of it can be run.
void add_files(const ExperimentText& text, const SweepPlan& plan, Json& files) {
  Experiment experiment;
  try {
    experiment = read_experiment(TomlTable::parse(text.text, text.file.string()));
  } catch (const InputError&) {
    return;
  }
  const auto add = [&](const std::string& name) {
    if (!name.empty()) files[name] = hash_of_file(text.file.parent_path() / name);
  };
  add(experiment.excitation.file.value_or(""));
  for (const Excitation& further : experiment.further_excitations) add(further.file.value_or(""));
  add(experiment.reduction.shape_file);
  for (const Choice& reduction : experiment.reductions) add(reduction.shape_file);
  for (const VariedKey& one : plan.varied)
    if (one.key.ends_with(".file") || one.key.ends_with(".shape_file"))
      for (const filters::OptionValue& value : one.values) add(word_of(value));
}

}  // namespace

std::string hash_of(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return fmt::format("{:016x}", hash);
}

Json manifest_of(const SweepSource& source, const SweepPlan& plan, const Shard& shard) {
  Json json{{"program", "beamid sweep"}, {"version", BEAMID_VERSION}};
  Json& described = json["plan"];
  described["vary"] = Json::array();
  for (const VariedKey& one : plan.varied) described["vary"].push_back(one.text);
  described["random"] = plan.samples;
  described["seeds"] = plan.seeds;
  described["seed"] = plan.seed;
  if (plan.once) described["identify"] = "once";
  described["cases"] = plan.cases();
  json["experiment"] = source.config.text;
  if (source.truth) json["truth"] = source.truth->text;
  if (source.record) json["record"] = source.record->filename().string();
  Json files = Json::object();
  if (source.record) files[source.record->filename().string()] = hash_of_file(*source.record);
  add_files(source.config, plan, files);
  if (source.truth) add_files(*source.truth, plan, files);
  if (!files.empty()) json["files"] = files;
  if (plan.once) json["instructions"] = filters::batch_instructions();
  json["hash"] = hash_of(json.dump(-1, ' ', false, Json::error_handler_t::replace));
  json["shard"] = {{"index", shard.index + 1}, {"count", shard.count}};
  return json;
}

Json read_manifest(const std::filesystem::path& file) {
  Json json = read_json(file, "the manifest.json of a sweep");
  if (json.value("program", Json()) != "beamid sweep" || !json.value("hash", Json()).is_string() ||
      !json.value("shard", Json()).is_object())
    throw InputError({file.string()}, "no manifest of a sweep; expected a folder that beamid sweep wrote");
  return json;
}

SweepPlan plan_of(const Json& manifest, const std::filesystem::path& file) {
  SweepPlan plan;
  try {
    const Json& described = manifest.at("plan");
    for (const Json& text : described.at("vary"))
      plan.varied.push_back(parse_varied(text.get<std::string>()));
    const auto count = [&](const char* key) {
      return static_cast<int>(whole_number(described.at(key), key, 0, std::numeric_limits<int>::max()));
    };
    plan.samples = count("random");
    plan.seeds = count("seeds");
    if (!described.at("seed").is_number_unsigned()) throw std::invalid_argument("seed is no whole number");
    plan.seed = described.at("seed").get<std::uint64_t>();
    plan.once = described.value("identify", "") == "once";
    check(plan);
  } catch (const Json::exception&) {
    throw InputError({file.string()}, "no plan of a sweep; expected what beamid sweep wrote");
  } catch (const std::exception& error) {
    throw InputError({file.string()}, fmt::format("no plan of a sweep: {}", error.what()));
  }
  return plan;
}

}  // namespace beamid::experiments
