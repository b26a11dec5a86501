
#include "experiments/studies/reduce/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "fem/assembly.hpp"
#include "reduction/reduction.hpp"

namespace beamid::experiments {
namespace {

using filters::OptionValue;
constexpr int wanted = 3;  // coordinates

// 1 - cos(pi x / 2 L) is zero with its slope at a clamped root, and satisfies no other support.
bool is_cantilever(const fem::Beam& beam) {
  return beam.supports.size() == 1 && beam.supports.front().position == 0.0 &&
         beam.supports.front().deflection && beam.supports.front().rotation;
}

// Evenly along the beam, the last one at the tip if that can move; not where a support holds the deflection.
std::vector<double> masters(const fem::Beam& beam) {
  const double length = beam.length();
  const bool tip = fem::natural_point(beam).position == length;
  std::vector<double> found;
  for (int i = 1; i <= wanted; ++i) {
    const double position = i == wanted && tip ? length : length * i / (tip ? wanted : wanted + 1);
    const bool held =
        std::any_of(beam.supports.begin(), beam.supports.end(), [&](const fem::Support& support) {
          return support.deflection && std::abs(support.position - position) < 1e-6 * length;
        });
    if (!held) found.push_back(position);
  }
  return found;
}

template <class Type>
bool has_option(const std::vector<filters::OptionSpec>& options, const char* name) {
  return std::any_of(options.begin(), options.end(), [&](const filters::OptionSpec& option) {
    return option.name == name && std::holds_alternative<Type>(option.fallback);
  });
}

// What an option says in a word.
std::string short_word(const std::string& name, const OptionValue& value) {
  if (const double* number = std::get_if<double>(&value)) return fmt::format("{:g}", *number);
  if (const bool* truth = std::get_if<bool>(&value)) return *truth ? name : "";
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  const auto& numbers = std::get<std::vector<double>>(value);
  return numbers.size() <= 3 ? fmt::format("{:.3g}", fmt::join(numbers, "/"))
                             : fmt::format("{} places", numbers.size());
}

std::string with_options(const Choice& choice) {
  std::string label = choice.name;
  for (const filters::OptionSpec& option : reduction::reduction_registry().find(choice.name).options) {
    const auto given = choice.options.values().find(option.name);
    if (given == choice.options.values().end() || given->second == option.fallback) continue;
    if (const std::string word = short_word(option.name, given->second); !word.empty()) label += " " + word;
  }
  return label;
}

}  // namespace

std::vector<Choice> default_reductions(const fem::Structure& structure) {
  const auto& registry = reduction::reduction_registry();
  std::vector<Choice> found;
  const auto add = [&](const std::string& name, const filters::Options& options) {
    found.push_back({name, registry.completed(name, options)});
  };
  add("rayleigh", {});
  if (structure.is_beam() && is_cantilever(structure.beam()))
    add("rayleigh", {{"shape", "one_minus_cosine"}});
  for (const auto& [name, entry] : registry.entries()) {
    if (name == "none" || name == "rayleigh") continue;
    filters::Options options;
    const bool at_masters = has_option<std::vector<double>>(entry.options, "masters_m");
    // The interface, the natural point, has two coordinates of its own.
    const bool interface = has_option<std::vector<double>>(entry.options, "interface_m");
    if (at_masters && structure.is_beam()) options.set("masters_m", masters(structure.beam()));
    if (!at_masters && has_option<double>(entry.options, "modes"))
      options.set("modes", static_cast<double>(interface ? wanted - 2 : wanted));
    if (has_option<double>(entry.options, "moments")) options.set("moments", static_cast<double>(wanted));
    add(name, options);
  }
  return found;
}

std::vector<std::string> labels(const std::vector<Choice>& choices) {
  std::map<std::string, int> names, taken;
  for (const Choice& choice : choices) ++names[choice.name];
  std::vector<std::string> found;
  for (const Choice& choice : choices)
    found.push_back(names[choice.name] == 1 ? choice.name : with_options(choice));
  names.clear();
  for (const std::string& label : found) ++names[label];
  for (std::string& label : found)
    if (names[label] > 1) label += fmt::format(" #{}", ++taken[label]);
  return found;
}

}  // namespace beamid::experiments
