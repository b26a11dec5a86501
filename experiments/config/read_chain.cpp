#include "experiments/config/read_chain.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <vector>

#include "experiments/config/key_tables.hpp"
#include "experiments/config/useless_keys.hpp"
#include "experiments/models/springs/spring_law.hpp"
#include "experiments/text/method_choice.hpp"
#include "fem/shear_building.hpp"

namespace beamid::experiments {
namespace {

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

}  // namespace

fem::Beam read_chain(const TomlTable& table) {
  return at_place(table.place(), [&] { return fem::shear_building(storeys_of(table)); });
}

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

}  // namespace beamid::experiments
