#include "experiments/config/read_experiment.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "experiments/config/experiment.hpp"
#include "experiments/config/key_tables.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/config/useless_keys.hpp"
#include "experiments/models/springs/spring_law.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/beam.hpp"
#include "fem/shear_building.hpp"
#include "fem/structural_system.hpp"

namespace beamid::experiments {
namespace {

// The table [frequency_response] of an experiment file.

const Schema<FrequencyResponseSettings>& frequency_response_keys() {
  using F = FrequencyResponseSettings;
  using Kind = F::Kind;
  constexpr int most_points = 1000000, most_modes = 1000;
  static const Schema<F> keys =
      Schema<F>("frequency_response")
          .key("from_hz", &F::from_hz, not_negative, "first frequency", "1")
          .values("number > 0 (0 with linear spacing)")
          .fallback("a fifth of the first natural frequency")
          .key("to_hz", &F::to_hz, {.least = 0.0, .above = true, .greater_than = "from_hz"}, "last frequency",
               "200")
          .fallback("1.2 times the third")
          .key("points", &F::points, {2, most_points}, "how many", "1000")
          .choice("spacing", &F::logarithmic, {std::pair{"linear", false}, {"logarithmic", true}},
                  "between them", "\"linear\"")
          .choice("kind", &F::kind,
                  {std::pair{to_string(Kind::receptance), Kind::receptance},
                   {to_string(Kind::mobility), Kind::mobility},
                   {to_string(Kind::accelerance), Kind::accelerance}},
                  "displacement, velocity or acceleration per force", "\"accelerance\"")
          .key(
              "method", [](F& f) -> std::string& { return f.method.name; },
              "solved at every frequency, or a sum over modes", "\"modal\"")
          .one_of({"direct", "modal"})
          .fallback("direct; modal for ratios and for Caughey with more than two anchors")
          .key(
              "modes", [](F& f) -> Eigen::Index& { return f.method.modes; }, {1, most_modes},
              "modal: how many", "20")
          .fallback("all, at most 200")
          .key(
              "residual_modes", [](F& f) -> bool& { return f.method.residual_modes; },
              "modal: the static deflection of the omitted modes is added", "false")
          .fallback("`true`")
          .tables({"pairs"});
  return keys;
}

const Schema<PointPair>& pair_keys() {
  static const Schema<PointPair> keys =
      Schema<PointPair>("frequency_response.pairs")
          .key("input_m", &PointPair::input, on_beam, "where the force acts", "1.1")
          .fallback("the tip, or midspan where the tip is held")
          .key("output_m", &PointPair::output, on_beam, "where motion is observed", "0.55")
          .fallback("likewise")
          .key("input_at", &PointPair::input_place, "in place of `input_m`, of a frame or a system",
               "\"ridge.x\"")
          .key("output_at", &PointPair::output_place, "likewise", "\"eaves.y\"");
  return keys;
}

const bool frequency_response_keys_registered[] = {
    register_keys([]() -> const KeyTable& { return frequency_response_keys(); }),
    register_keys([]() -> const KeyTable& { return pair_keys(); })};

/// @param length of the beam, to which every position must belong [m].
/// @throws InputError for a useless or a bad value.
FrequencyResponseSettings read_frequency_response(const TomlTable& table, const fem::Structure& structure) {
  FrequencyResponseSettings settings = frequency_response_keys().read(table);
  if (settings.logarithmic) table.find_number("from_hz", Sign::positive);
  for (const TomlTable& pair : table.find_tables("pairs")) {
    settings.pairs.push_back(pair_keys().read(pair, structure.extent()));
    settings.pairs.back().input_place = read_place(pair, structure, true, "input_at", "input_m");
    settings.pairs.back().output_place = read_place(pair, structure, true, "output_at", "output_m");
  }
  if (settings.method.name == "direct")
    refuse_useless(table, {"modes", "residual_modes"}, "with method = \"direct\"", "method = \"modal\"");
  return settings;
}

// The table [damping] of an experiment file.

struct DampingValues {
  std::optional<std::string> law;
  std::optional<double> ratio, loss_factor;
  std::optional<std::vector<double>> ratios;
};

const Schema<DampingValues>& damping_keys() {
  using D = DampingValues;
  static const Schema<D> keys =
      Schema<D>("damping")
          .selected_by("law")
          .key("law", &D::law,
               "ratios as such; through two anchors; through any number of them; hysteretic: eta in `frf`, "
               "eta/2 of viscous damping per mode in `simulate`",
               "\"rayleigh\"")
          .one_of({"none", "modal", "rayleigh", "caughey", "structural"})
          .fallback("`\"none\"`; `\"modal\"` where ratios are given")
          .key("ratio", &D::ratio, not_negative, "modal: of every mode", "0.002")
          .with({"modal"})
          .replaces({"law", "ratios", "anchors", "loss_factor"})
          .key("ratios", &D::ratios, not_negative, "modal: of mode 1, 2, ...; the last one of all above",
               "[0.002, 0.005]")
          .with({"modal"})
          .excludes({"ratio"})
          .replaces({"law", "anchors", "loss_factor"})
          .key("loss_factor", &D::loss_factor, not_negative, "structural: eta of K (1 + i eta)", "0.01")
          .needed_with({"structural"})
          .replaces({"ratio", "ratios", "anchors"})
          .other("anchors", Key::Type::tables)
          .required("an array of tables { frequency_hz, ratio }")
          .needed_with({"rayleigh", "caughey"});
  return keys;
}

const Schema<fem::DampingAnchor>& anchor_keys() {
  static const Schema<fem::DampingAnchor> keys =
      Schema<fem::DampingAnchor>("damping.anchors")
          .key("frequency_hz", &fem::DampingAnchor::frequency_hz, positive, "frequency", "3.5")
          .required()
          .key("ratio", &fem::DampingAnchor::ratio, not_negative, "damping ratio there", "0.002")
          .required();
  return keys;
}

const bool damping_keys_registered[] = {register_keys([]() -> const KeyTable& { return damping_keys(); }),
                                        register_keys([]() -> const KeyTable& { return anchor_keys(); })};

fem::DampingLaw law_of(const TomlTable& table, const DampingValues& given, const std::string& law) {
  if (law == "none") return {};
  if (law == "structural") return fem::StructuralDamping{*given.loss_factor};
  if (law == "modal") {
    if (!given.ratio && !given.ratios)
      table.miss("ratio", "the damping ratio of every mode, or ratios = [first, second, ...]");
    return fem::ModalDamping{given.ratios ? *given.ratios : std::vector{*given.ratio}};
  }
  std::vector<fem::DampingAnchor> anchors;
  for (const TomlTable& anchor : table.find_tables("anchors")) anchors.push_back(anchor_keys().read(anchor));
  if (law == "caughey") return fem::CaugheyDamping{anchors};
  if (anchors.size() != 2)
    table.refuse("anchors", "two of them, { frequency_hz, ratio }; more are for law = \"caughey\"");
  return fem::RayleighDamping{anchors[0], anchors[1]};
}

/// law = "none", "modal", "rayleigh", "caughey" or "structural", and what that law needs.
/// @throws InputError for a missing, a useless or an impossible value.
fem::DampingLaw read_damping(const TomlTable& table) {
  const DampingValues given = damping_keys().read(table);
  const std::string law = given.law.value_or(given.ratio || given.ratios ? "modal" : "none");
  damping_keys().check_use(table, law);
  const fem::DampingLaw damping = law_of(table, given, law);
  at_place(table.value_place(table.contains("anchors") ? "anchors" : "law"),
           [&] { fem::damping_ratios(damping, {}); });  // what is impossible whatever the modes
  return damping;
}

// The table [chain] of an experiment file.

using Numbers = std::optional<std::vector<double>>;

struct GivenChain {
  Numbers masses, stiffnesses, dashpots, heights;
};

const Schema<GivenChain>& chain_keys() {
  using C = GivenChain;
  static const Schema<C> keys =
      Schema<C>("chain")
          .key("masses_kg", &C::masses, positive, "of the floors, from the lowest up", "[1000, 1000, 800]")
          .key("stiffnesses_n_per_m", &C::stiffnesses, positive,
               "of the storey below each floor: what holds the floor against the one below it, or the base",
               "[2e6, 2e6, 1.6e6]")
          .key("dashpots_n_s_per_m", &C::dashpots, not_negative, "likewise", "[300, 300, 240]")
          .fallback("none")
          .key("heights_m", &C::heights, positive, "of the storeys; places are heights above the base",
               "[3, 3, 3]")
          .fallback("1 m each")
          .tables({"layers", "storeys"});
  return keys;
}

const Schema<fem::SoilLayer>& layer_keys() {
  using L = fem::SoilLayer;
  static const Schema<L> keys =
      Schema<L>("chain.layers")
          .key("thickness_m", &L::thickness, positive, "of the layer, the lowest one first", "6.0")
          .required()
          .key("density_kg_per_m3", &L::density, positive, "of the soil, water included", "1900")
          .required()
          .key("shear_wave_velocity_m_per_s", &L::shear_wave_velocity, positive,
               "v of the stiffness rho v^2 / h of a square metre", "190")
          .required();
  return keys;
}

constexpr int most_storeys = 100000;

const Schema<StoreySpring>& storey_keys() {
  static const Schema<StoreySpring> keys =
      Schema<StoreySpring>("chain.storeys")
          .with_options()
          .key("storey", &StoreySpring::storey, {1, most_storeys},
               "whose spring follows the law, from the lowest, 1, up; of layers, the layer", "1")
          .required()
          .other("law", Key::Type::text,
                 "a name from `beamid list springs`; its parameters stand beside it, and the stiffness at "
                 "rest is that of the chain",
                 "\"bouc_wen\"")
          .required("a name from `beamid list springs`");
  return keys;
}

const bool storey_keys_registered = register_keys([]() -> const KeyTable& { return storey_keys(); });
const bool chain_keys_registered = register_keys([]() -> const KeyTable& { return chain_keys(); });
const bool layer_keys_registered = register_keys([]() -> const KeyTable& { return layer_keys(); });

fem::Storeys storeys_of(const TomlTable& table) {
  const GivenChain given = chain_keys().read(table);
  const std::vector<TomlTable> layers = table.find_tables("layers");
  if (!layers.empty()) {
    refuse_useless(table, {"masses_kg", "stiffnesses_n_per_m", "heights_m"}, "beside chain.layers",
                   "one or the other");
    std::vector<fem::SoilLayer> soil;
    for (const TomlTable& layer : layers) soil.push_back(layer_keys().read(layer));
    fem::Storeys column = fem::soil_column(soil);
    column.dashpots = given.dashpots.value_or(std::vector<double>{});
    return column;
  }
  for (const char* const key : {"masses_kg", "stiffnesses_n_per_m"})
    if (!table.contains(key)) table.miss(key, "numbers, one for each floor, or [[chain.layers]]");
  return {*given.masses, *given.stiffnesses, given.dashpots.value_or(std::vector<double>{}),
          given.heights.value_or(std::vector<double>{})};
}

/// Floors on storeys, or layers of soil in [[chain.layers]], as fem/shear_building.hpp makes a beam of them.
/// @throws InputError where the numbers of values differ, at a missing or a useless key
fem::Beam read_chain(const TomlTable& table) {
  return at_place(table.place(), [&] { return fem::shear_building(storeys_of(table)); });
}

/// [[chain.storeys]]: the laws of storeys that are not linear, by storey.
/// @throws InputError at a storey that there is not, or twice, at an unknown law, and where a parameter of
/// the law is missing or out of range
std::vector<StoreySpring> read_storey_springs(const TomlTable& table, const fem::Beam& chain) {
  std::vector<StoreySpring> springs;
  const int count = static_cast<int>(chain.segments.size());
  for (const TomlTable& one : table.find_tables("storeys")) {
    StoreySpring spring = storey_keys().read(one);
    if (spring.storey > count) one.refuse("storey", fmt::format("a storey from 1 to {}", count));
    for (const StoreySpring& other : springs)
      if (other.storey == spring.storey) one.refuse("storey", "another one: this has a law already");
    spring.law = read_choice(one, "law", "", spring_law_registry(), storey_keys().names());
    for (const SpringParameter& parameter :
         spring_law_registry().make(spring.law.name, spring.law.options)->parameters())
      if (!one.contains(parameter.key()))
        one.miss(parameter.key(), "the number of law '" + spring.law.name + "'");
    if (spring.law.name != "linear") springs.push_back(spring);
  }
  return springs;
}

/// @throws InputError at a place between floors.
void check_places_on_chain(const TomlTable& root, const fem::Beam& chain) {
  const auto check = [&](const TomlTable& table) {
    if (!table.contains("position_m")) return;
    const double position = table.number("position_m");
    double height = 0.0;
    std::string floors;
    for (const fem::Segment& storey : chain.segments) {
      height += storey.length;
      if (std::abs(position - height) < 1e-9 * chain.length()) return;
      floors += fmt::format("{}{:g}", floors.empty() ? "" : ", ", height);
    }
    throw InputError(table.value_place("position_m"),
                     fmt::format("position_m is {:g}; expected the height of a floor: {}", position, floors));
  };
  for (const TomlTable& sensor : root.find_tables("sensors")) check(sensor);
  if (const auto excitation = root.find_table("excitation")) check(*excitation);
  for (const TomlTable& excitation : root.find_tables("excitations")) check(excitation);
  if (const auto record = root.find_table("record"))
    for (const TomlTable& channel : record->find_tables("channels")) check(channel);
}

const Schema<Experiment>& root_keys() {
  constexpr auto table = Key::Type::table, tables = Key::Type::tables;
  static const Schema<Experiment> keys =
      Schema<Experiment>("")
          .key("title", &Experiment::title, "printed on top of results and plots", "\"steel cantilever\"")
          .tables({"beam", "chain", "system", "damping", "excitation"}, table)
          .tables({"excitations", "sensors"}, tables)
          .tables({"acquisition", "simulation", "frequency_response", "record", "reduction"}, table)
          .tables({"reductions"}, tables)
          .tables({"model"}, table)
          .tables({"parameters", "substructures", "unknown_forces", "virtual_sensors"}, tables)
          .tables({"filter"}, table)
          .tables({"filters"}, tables)
          .tables(
              {"fatigue", "compare", "identifiability", "prior", "noise", "frame", "space_frame", "sweep"},
              table);
  return keys;
}

const bool root_keys_registered = register_keys([]() -> const KeyTable& { return root_keys(); });

/// The one structure that the file describes.
void read_structure(const TomlTable& root, Experiment& experiment) {
  const char* found = nullptr;
  for (const char* const kind : {"beam", "chain", "frame", "space_frame", "system"})
    if (root.contains(kind)) {
      if (found)
        throw InputError(root.key_place(kind),
                         fmt::format("{} beside {}; expected one structure", kind, found));
      found = kind;
    }
  if (const auto frame = root.find_table("frame")) {
    const FrameExperiment described = read_frame(*frame);
    experiment.structure = described.frame;
    experiment.elements = described.elements_per_member;
  } else if (const auto space = root.find_table("space_frame")) {
    const SpaceFrameExperiment described = read_space_frame(*space);
    experiment.structure = described.frame;
    experiment.elements = described.elements_per_member;
  } else if (const auto system = root.find_table("system")) {
    experiment.structure = read_system(*system);
    experiment.elements = 1;
  } else if (const auto chain = root.find_table("chain")) {
    experiment.structure = read_chain(*chain);
    experiment.elements = static_cast<int>(experiment.structure.beam().segments.size());
    experiment.storey_springs = read_storey_springs(*chain, experiment.structure.beam());
    check_places_on_chain(root, experiment.structure.beam());
  } else {
    const TomlTable beam = root.table("beam");
    experiment.structure = read_beam(beam);
    experiment.elements = read_elements(beam);
  }
}

/// What is done with the structure itself.
void read_continuum(const TomlTable& root, Experiment& experiment) {
  const fem::Structure& structure = experiment.structure;
  if (const auto damping = root.find_table("damping")) experiment.damping = read_damping(*damping);
  if (const auto excitation = root.find_table("excitation"))
    experiment.excitation = read_excitation(*excitation, structure);
  if (const auto several = read_simultaneous_excitations(root, structure); !several.empty()) {
    experiment.excitation = several.front();
    experiment.further_excitations.assign(several.begin() + 1, several.end());
  }
  experiment.sensors = read_sensors(root, structure);
  experiment.acquisition = read_acquisition(root);
  experiment.parameters = read_parameters(root, structure);
  experiment.parts = read_parts(root, structure);
  experiment.unknown_forces = read_unknown_forces(root, structure);
  experiment.virtual_sensors = read_virtual_sensors(root, structure);
  experiment.fatigue = read_fatigue(root);
  if (const auto simulation = root.find_table("simulation"))
    experiment.simulation = read_simulation(*simulation);
  if (const auto response = root.find_table("frequency_response"))
    experiment.frequency_response = read_frequency_response(*response, structure);
}

}  // namespace

Experiment read_experiment(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  return read_experiment(TomlTable::read(file, overrides));
}

Experiment read_experiment(const TomlTable& root) {
  refuse_unknown_keys(root);
  check_values(root);
  Experiment experiment = root_keys().read(root);
  experiment.file = root;
  read_structure(root, experiment);
  experiment.format.irregular = true;  // as [record] has it unless it says otherwise
  if (const auto record = root.find_table("record")) {
    const RecordSection section = read_record_section(*record, &experiment.structure);
    experiment.record_file = section.file;
    experiment.format = section.format;
  }
  read_continuum(root, experiment);
  read_methods(root, experiment);
  if (const auto table = root.find_table("identifiability"))
    experiment.identifiability = identifiability_keys().read(*table);
  read_prior(root, experiment);
  check_tables_of_others(root);
  return experiment;
}

}  // namespace beamid::experiments
