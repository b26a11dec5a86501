#include "experiments/config/description.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "experiments/config/experiment.hpp"
#include "experiments/config/key_tables.hpp"
#include "experiments/config/structure_description.hpp"
#include "fem/shear_building.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

// Null where the key has none, where it has no use with what is given, or where that says the same otherwise.
Json default_beside(const Json& given, const std::string& selected, const Key& key, const KeyTable& section) {
  const auto is_given = [&](const std::string& name) { return given.contains(name); };
  const std::vector<std::string> rivals = section.rivals(key.name);
  const bool of_use =
      key.with.empty() || std::find(key.with.begin(), key.with.end(), selected) != key.with.end();
  if (!of_use || std::any_of(rivals.begin(), rivals.end(), is_given)) return nullptr;
  return std::visit(
      [](const auto& value) -> Json {
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, std::monostate>) return nullptr;
        if constexpr (std::is_same_v<Value, double>)
          if (!std::isfinite(value)) return nullptr;
        if constexpr (std::is_same_v<Value, std::string>)
          if (value.empty()) return nullptr;
        if constexpr (!std::is_same_v<Value, std::monostate>) return value;
      },
      key.preset);
}

std::string selected_in(const Json& given, const KeyTable& section) {
  if (given.contains(section.selector())) return given.at(section.selector());
  const Key* const selector = section.find(section.selector());
  const std::string* const preset = selector ? std::get_if<std::string>(&selector->preset) : nullptr;
  return preset ? *preset : "";
}

Json completed(const Json& given, const KeyTable& section, bool stands_once) {
  const auto value_of = [&](const Key& key) -> Json {
    const Json& value = given.at(key.name);
    const KeyTable* const inner =
        find_key_table(section.name().empty() ? key.name : section.name() + "." + key.name);
    if (inner == nullptr) return value;
    if (!value.is_array()) return completed(value, *inner, true);
    Json all = Json::array();
    for (const Json& one : value) all.push_back(completed(one, *inner, false));
    return all;
  };
  Json json = Json::object();
  const std::string selected = selected_in(given, section);
  for (const Key& key : section.keys())
    if (given.contains(key.name))
      json[key.name] = value_of(key);
    else if (stands_once)
      if (Json value = default_beside(given, selected, key, section); !value.empty())
        json[key.name] = std::move(value);
  for (const auto& [name, value] : given.items())  // options of the method chosen
    if (!json.contains(name)) json[name] = value;
  return json;
}

// A whole number as one, whatever type the option has.
Json option_value(const filters::OptionValue& value) {
  const double* const number = std::get_if<double>(&value);
  constexpr double largest = 0x1p53;
  if (number && std::abs(*number) <= largest && *number == std::floor(*number))
    return static_cast<std::int64_t>(*number);
  return std::visit([](const auto& held) { return Json(held); }, value);
}

Json list_of(const std::vector<Choice>& choices) {
  Json list = Json::array();
  for (const Choice& choice : choices) list.push_back(keys_of(choice, "method"));
  return list;
}

}  // namespace

Json effective_keys(const TomlTable& root, const std::vector<std::string>& also) {
  Json given = Json::parse(root.json());
  // A release has a place of its own on beams alone.
  const auto rules_out = [&](const std::string& table) {
    return table == "excitation" && (given.contains("excitations") || given.contains("frame") ||
                                     given.contains("space_frame") || given.contains("system"));
  };
  for (const std::string& table : also)
    if (!given.contains(table) && !rules_out(table)) given[table] = Json::object();
  return completed(given, *find_key_table(""), true);
}

Json effective_keys(const Experiment& experiment, const std::vector<std::string>& also) {
  if (!experiment.file) return Json::object();
  Json keys = effective_keys(*experiment.file, also);
  const auto choose = [&](const char* table, Json chosen) {
    if (!keys.contains(table)) return;
    for (const auto& [key, value] : keys[table].items())
      if (!chosen.contains(key) && find_key_table(table)->find(key) != nullptr) chosen[key] = value;
    keys[table] = std::move(chosen);
  };
  Json filter = keys_of(experiment.filter, "method");
  filter.update({{"discretisation", experiment.discretisation},
                 {"on_failure", to_string(experiment.on_failure)},
                 {"estimator", experiment.estimator}});
  if (!experiment.smoother.empty()) filter["smoother"] = experiment.smoother;
  choose("filter", std::move(filter));
  choose("model", keys_of(experiment.model, "name"));
  choose("reduction", keys_of(experiment.reduction, "method"));
  if (!experiment.reductions.empty()) keys["reductions"] = list_of(experiment.reductions);
  if (!experiment.filters.empty()) keys["filters"] = list_of(experiment.filters);
  if (!experiment.discretisations.empty()) {
    keys["compare"]["discretisations"] = experiment.discretisations;
    keys["compare"]["passes"] = experiment.passes;
  }
  if (const auto& window = experiment.format.window)
    keys["record"]["window_s"] = {window->first, window->second};
  return keys;
}

Json keys_of(const Choice& choice, const char* key) {
  Json json{{key, choice.name}};
  if (!choice.shape_file.empty()) json["shape_file"] = choice.shape_file;
  for (const auto& [option, value] : choice.options.values()) json[option] = option_value(value);
  return json;
}

namespace {

using Json = nlohmann::ordered_json;

std::string range(const fem::Beam& beam,
                  const std::function<const fem::Variation&(const fem::Section&)>& quantity) {
  double least = INFINITY, most = -INFINITY;
  for (const fem::Segment& segment : beam.segments)
    for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      least = std::min(least, quantity(segment.section)(s));
      most = std::max(most, quantity(segment.section)(s));
    }
  return least == most ? fmt::format("{:.6g}", least) : fmt::format("{:.6g} to {:.6g}", least, most);
}

std::string held(const fem::Beam& beam) {
  std::string text;
  for (const fem::Support& support : beam.supports)
    text += fmt::format("{}{} at {:g} m", text.empty() ? "" : ", ",
                        !support.rotation    ? "pinned"
                        : support.deflection ? "clamped"
                                             : "guided",
                        support.position);
  return text.empty() ? "nowhere held" : text;
}

std::string count(std::size_t number, const char* one, const char* many) {
  return number == 0 ? "" : fmt::format("; {} {}", number, number == 1 ? one : many);
}

std::string storeys_text(const fem::Beam& beam) {
  double softest = INFINITY, stiffest = 0.0, lightest = INFINITY, heaviest = 0.0;
  for (const fem::Segment& storey : beam.segments) {
    const double k = fem::storey_stiffness(storey);
    softest = std::min(softest, k), stiffest = std::max(stiffest, k);
  }
  for (const fem::Body& floor : beam.bodies)
    lightest = std::min(lightest, floor.mass), heaviest = std::max(heaviest, floor.mass);
  const auto span = [](double least, double most) {
    return least == most ? fmt::format("{:.6g}", least) : fmt::format("{:.6g} to {:.6g}", least, most);
  };
  return fmt::format("Chain: {} floors of {} kg on storeys of {} N/m, {:.6g} m high; {} degrees of freedom.",
                     beam.segments.size(), span(lightest, heaviest), span(softest, stiffest), beam.length(),
                     beam.segments.size());
}

}  // namespace

std::string bending_stiffness_text(const fem::Beam& beam) {
  return range(
      beam, [](const auto& s) -> auto& { return s.bending_stiffness; });
}

std::string damping_text(const fem::DampingLaw& law, const fem::StructuralSystem& system) {
  const std::string text = fem::name(law);
  if (system.damping.nonZeros() == 0) return text;
  return std::holds_alternative<fem::Undamped>(law) ? "dashpots" : text + " and dashpots";
}

std::string beam_text(const fem::Beam& beam, int elements, Eigen::Index coordinates) {
  if (beam.shear_building) return storeys_text(beam);
  const bool timoshenko =
      std::any_of(beam.segments.begin(), beam.segments.end(),
                  [](const fem::Segment& segment) { return segment.section.shear_stiffness; });
  std::string text =
      fmt::format("{} beam: {:g} m, EI = {} N m2, {} kg/m, {:.6g} kg; {}",
                  timoshenko ? "Timoshenko" : "Euler-Bernoulli", beam.length(), bending_stiffness_text(beam),
                  range(
                      beam, [](const auto& s) -> auto& { return s.mass_per_length; }),
                  beam.mass(), held(beam));
  for (const fem::Body& body : beam.bodies) {
    text += fmt::format("; {:.6g} kg", body.mass);
    if (body.rotary_inertia != 0.0) text += fmt::format(", {:.6g} kg m2", body.rotary_inertia);
    text += body.position == beam.length() ? " at the tip" : fmt::format(" at {:g} m", body.position);
    if (body.eccentricity != 0.0) text += fmt::format(", {:g} m beyond", body.eccentricity);
  }
  for (const fem::Spring& spring : beam.springs) {
    std::string constants;
    const auto add = [&](double value, const char* unit) {
      if (value != 0.0) constants += fmt::format("{}{:.6g} {}", constants.empty() ? "" : ", ", value, unit);
    };
    add(spring.translational, "N/m"), add(spring.rotational, "N m/rad"), add(spring.cubic, "N/m3");
    text +=
        fmt::format("; at {:g} m a spring of {}", spring.position, constants.empty() ? "0 N/m" : constants);
  }
  text += count(beam.dashpots.size(), "dashpot", "dashpots") +
          count(beam.absorbers.size(), "absorber", "absorbers") +
          count(beam.damages.size(), "damage", "damages") +
          count(beam.added_masses.size(), "added mass", "added masses");
  if (beam.axial_load != 0.0)
    text += fmt::format("; {:.6g} N of {}", std::abs(beam.axial_load),
                        beam.axial_load > 0.0 ? "compression" : "tension");
  return text + fmt::format(". {} elements{}, {} degrees of freedom.", elements,
                            beam.mass_model == fem::MassModel::lumped ? " with lumped mass" : "",
                            coordinates);
}

Json describe(const Experiment& experiment, const std::vector<std::string>& also) {
  Json json{{"title", experiment.title}};
  if (experiment.file) json["experiment"] = effective_keys(experiment, also);
  json["structure"] = describe(experiment.structure, experiment.elements);
  return json;
}

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

}  // namespace beamid::experiments
