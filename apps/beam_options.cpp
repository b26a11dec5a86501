#include "apps/beam_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "experiments/config/key_tables.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/identify/verdict/plausibility.hpp"

namespace beamid::apps {
namespace {

using namespace experiments;

// The steel beam of [inverse2009]: 3.055 kg as a density, so that another length or section weighs what it
// should.
constexpr const char* study_beam = R"toml([beam]
length_m = 1.10
width_m = 0.060
height_m = 0.006
youngs_modulus_pa = 2.12e11
density_kg_per_m3 = 7714.646464646465
)toml";

const std::vector<KeyOption>& beam_keys() {
  static const std::vector<KeyOption> keys{
      {number("length", "M", "length of the beam [m]"), "beam", "length_m"},
      {number("width", "M", "section across the direction of bending [m]"), "beam", "width_m"},
      {number("height", "M", "section along the direction of bending [m]"), "beam", "height_m"},
      {number("diameter", "M", "of a round section, instead of width and height [m]"), "beam", "diameter_m"},
      {number("youngs-modulus", "PA", "Young's modulus [Pa]"), "beam", "youngs_modulus_pa"},
      {number("density", "KG/M3", "density [kg/m3]"), "beam", "density_kg_per_m3"},
      {number("beam-mass", "KG", "mass of the beam alone, instead of its density [kg]"), "beam", "mass_kg"},
      {number("tip-mass", "KG", "rigid mass at the tip [kg]"), "beam", "tip_mass_kg"},
      {number("tip-inertia", "KG_M2", "of the tip mass about its own centre [kg m2]"), "beam",
       "tip_rotary_inertia_kg_m2"},
      {number("tip-eccentricity", "M",
              "distance of the tip mass's centre beyond the tip, along the axis [m]"),
       "beam", "tip_eccentricity_m"},
      {number("axial-load", "N", "dead axial load, positive in compression [N]"), "beam", "axial_load_n"},
      {number("root-rotational-stiffness", "NM/RAD",
              "of a spring that holds the root's rotation in place of the clamp [N m/rad]"),
       "beam", "root_rotational_stiffness_n_m_per_rad"},
      {text("support", "ROOT-TIP",
            "how the ends are held: clamped-free, clamped-clamped, pinned-pinned, free-free, ... every pair "
            "of clamped, pinned, guided, free")
           .such_as(end_supports()),
       "beam", "support"},
      {number("damping-ratio", "XI", "damping ratio of every mode"), "damping", "ratio"}};
  return keys;
}

void add_overrides(const std::vector<KeyOption>& keys, const Values& values,
                   std::vector<Override>& overrides) {
  for (const auto& [option, table, key] : keys) {
    if (!values.has(option.name)) continue;
    filters::OptionValue value;
    if (option.type == Option::Type::text)
      value = values.text(option.name);
    else
      value = values.number(option.name);
    overrides.push_back({table, key, value, "--" + option.name, find_key_table(table)->rivals(key)});
  }
}

/// "--tip-mass 0.65 --length 1"
std::string changes(const Values& values) {
  std::string text;
  for (const KeyOption& key : beam_keys())
    if (values.has(key.option.name))
      text += (text.empty() ? "--" : " --") + key.option.name + " " + values.text(key.option.name);
  return text;
}

/// The table of the structure that the file describes, "beam" without one and where there is none: the reader
/// says it.
std::string structure_in(const std::filesystem::path& config) {
  if (config.empty()) return "beam";
  const TomlTable file = TomlTable::read(config);
  for (const char* const table : {"frame", "space_frame", "chain", "system"})
    if (file.contains(table) && !file.contains("beam")) return table;
  return "beam";
}

void refuse_beams_options(const Values& values, const std::string& structure,
                          const std::filesystem::path& config) {
  for (const KeyOption& key : beam_keys())
    if (values.has(key.option.name) && std::string("beam") == key.table && structure != "beam")
      throw UsageError(
          fmt::format("--{} is of a beam; {} describes a {}", key.option.name, config.string(), structure));
}

/// The key that says it of this structure.
Override elements_of(const std::string& structure, int elements) {
  if (structure == "beam") return {structure, "elements", 1.0 * elements, "--elements"};
  if (structure == "frame" || structure == "space_frame")
    return {structure, "elements_per_member", 1.0 * elements, "--elements"};
  throw UsageError("--elements has no use here: a " + structure + " is not meshed");
}

void refuse_both(const Values& values, const std::string& one, const std::string& other) {
  if (values.has(one) && values.has(other))
    throw UsageError("--" + one + " and --" + other + " exclude each other; expected one of them");
}

}  // namespace

OptionGroup key_options(const std::vector<KeyOption>& keys, std::vector<Option> more) {
  std::vector<Option> options;
  for (const KeyOption& key : keys) options.push_back(key.option);
  std::move(more.begin(), more.end(), std::back_inserter(options));
  return {"Options", std::move(options)};
}

Option surface_option() {
  return flag("surface", "draw the real sections in the meshes for ParaView");
}

std::vector<KeyOption> record_length_keys() {
  return {{number("duration", "S", "of the record [s]"), "simulation", "duration_s"},
          {number("sampling-rate", "HZ", "of the record [Hz]"), "simulation", "sampling_rate_hz"}};
}

OptionGroup beam_options() {
  OptionGroup group = key_options(
      beam_keys(),
      {whole("elements", "N", 1, most_elements, "finite elements along the beam").by_default("40")});
  group.title =
      "Beam (without any: the study's steel beam, 1.10 m x 60 mm x 6 mm, 2.12e11 Pa, 3.055 kg; each option "
      "takes the place of one quantity of it, or of FILE)";
  group.options.insert(group.options.begin(), config_option());
  return group;
}

BeamSource read_beam(const Values& values, const std::vector<KeyOption>& more) {
  refuse_both(values, "diameter", "width");
  refuse_both(values, "diameter", "height");
  refuse_both(values, "density", "beam-mass");
  std::vector<Override> overrides;
  add_overrides(beam_keys(), values, overrides);
  const bool changed = !overrides.empty();
  add_overrides(more, values, overrides);

  BeamSource source;
  if (values.has("config")) source.config = values.text("config");
  if (changed || values.has("elements")) {
    const std::string structure = structure_in(source.config);
    refuse_beams_options(values, structure, source.config);
    if (values.has("elements")) overrides.push_back(elements_of(structure, values.whole("elements")));
  }
  if (values.has("config")) {
    source.experiment = read_experiment(source.config, overrides);
    if (std::string& title = source.experiment.title; changed && !title.empty())
      title += " (with " + changes(values) + ")";
  } else {
    source.experiment = read_experiment(TomlTable::parse(study_beam, "the study's beam", overrides));
    source.experiment.title =
        changed ? "The study's steel beam, 2.12e11 Pa and 7715 kg/m3 (with " + changes(values) + ")"
                : "The study's steel beam (no --config and no other beam given)";
  }
  return source;
}

Results blame_config(const BeamSource& source, const std::function<Results()>& find) {
  try {
    Results results = find();
    warn(results, source.experiment);
    return results;
  } catch (const std::invalid_argument& error) {
    if (source.config.empty()) throw;
    throw InputError({source.config.string()}, error.what());
  }
}

}  // namespace beamid::apps
