#include "apps/beam_options.hpp"

#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/plausibility.hpp"

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
  const std::vector<std::string> round{"diameter_m", "end_diameter_m"};
  static const std::vector<KeyOption> keys{
      {"length", "beam", "length_m", {}, "M", "length of the beam [m]"},
      {"width", "beam", "width_m", round, "M", "section across the direction of bending [m]"},
      {"height", "beam", "height_m", round, "M", "section along the direction of bending [m]"},
      {"diameter",
       "beam",
       "diameter_m",
       {"width_m", "height_m", "end_width_m", "end_height_m"},
       "M",
       "of a round section, instead of width and height [m]"},
      {"youngs-modulus",
       "beam",
       "youngs_modulus_pa",
       {"bending_stiffness_n_m2"},
       "PA",
       "Young's modulus [Pa]"},
      {"density",
       "beam",
       "density_kg_per_m3",
       {"mass_kg", "mass_per_length_kg_per_m"},
       "KG/M3",
       "density [kg/m3]"},
      {"beam-mass",
       "beam",
       "mass_kg",
       {"density_kg_per_m3", "mass_per_length_kg_per_m"},
       "KG",
       "mass of the beam alone, instead of its density [kg]"},
      {"tip-mass", "beam", "tip_mass_kg", {}, "KG", "rigid mass at the tip [kg]"},
      {"tip-inertia",
       "beam",
       "tip_rotary_inertia_kg_m2",
       {},
       "KG M2",
       "of the tip mass about its own centre [kg m2]"},
      {"tip-eccentricity",
       "beam",
       "tip_eccentricity_m",
       {},
       "M",
       "distance of the tip mass's centre beyond the tip, along the axis [m]"},
      {"axial-load", "beam", "axial_load_n", {}, "N", "dead axial load, positive in compression [N]"},
      {"root-rotational-stiffness",
       "beam",
       "root_rotational_stiffness_n_m_per_rad",
       {},
       "NM/RAD",
       "of a spring that holds the root's rotation in place of the clamp [N m/rad]"},
      {"support",
       "beam",
       "support",
       {},
       "ROOT-TIP",
       "how the ends are held: clamped-free, clamped-clamped, pinned-pinned, free-free, ... every pair of "
       "clamped, pinned, guided, free",
       true},
      {"damping-ratio",
       "damping",
       "ratio",
       {"law", "ratios", "anchors", "loss_factor"},
       "XI",
       "damping ratio of every mode"}};
  return keys;
}

void add_overrides(const std::vector<KeyOption>& keys, const options::variables_map& values,
                   std::vector<Override>& overrides) {
  for (const KeyOption& key : keys) {
    if (!values.count(key.option)) continue;
    filters::OptionValue value;
    if (key.is_text)
      value = values[key.option].as<std::string>();
    else
      value = values[key.option].as<double>();
    overrides.push_back({key.table, key.key, value, std::string("--") + key.option, key.instead_of});
  }
}

void refuse_both(const Command& command, const options::variables_map& values, const char* one,
                 const char* other) {
  if (values.count(one) && values.count(other))
    throw UsageError(command.name + ": --" + one + " and --" + other +
                     " exclude each other; expected one of them");
}

}  // namespace

void describe(const std::vector<KeyOption>& keys, options::options_description& described) {
  for (const KeyOption& key : keys)
    if (key.is_text)
      described.add_options()(key.option, options::value<std::string>()->value_name(key.value_name),
                              key.help);
    else
      described.add_options()(key.option, options::value<double>()->value_name(key.value_name), key.help);
}

options::options_description beam_options() {
  options::options_description described(
      "Beam (without any: the study's steel beam, 1.10 m x 60 mm x 6 mm, 2.12e11 Pa, 3.055 kg; each option "
      "takes the place of one quantity of it, or of FILE)");
  described.add_options()("config", options::value<std::string>()->value_name("FILE"),
                          "experiment file (docs/configuration.md)");
  describe(beam_keys(), described);
  described.add_options()("elements", options::value<int>()->value_name("N"),
                          "finite elements along the beam [40]");
  return described;
}

BeamSource read_beam(const Command& command, const options::variables_map& values,
                     const std::vector<KeyOption>& more) {
  refuse_both(command, values, "diameter", "width");
  refuse_both(command, values, "diameter", "height");
  refuse_both(command, values, "density", "beam-mass");
  std::vector<Override> overrides;
  add_overrides(beam_keys(), values, overrides);
  const bool changed = !overrides.empty();
  add_overrides(more, values, overrides);

  BeamSource source;
  if (values.count("config")) {
    source.config = values["config"].as<std::string>();
    source.experiment = read_experiment(source.config, overrides);
  } else {
    source.experiment = read_experiment(TomlTable::parse(study_beam, "the study's beam", overrides));
    if (!changed) source.experiment.title = "The study's steel beam (no --config and no other beam given)";
  }
  if (values.count("elements")) {
    const int elements = values["elements"].as<int>();
    if (elements < 1 || elements > most_elements)
      throw InputError({"--elements"}, std::to_string(elements) + "; expected a whole number from 1 to " +
                                           std::to_string(most_elements));
    source.experiment.elements = elements;
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
