#include "experiments/models/unknown.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include <fmt/format.h>

#include "experiments/models/springs/spring_law.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {

const char* to_string(Form form) {
  switch (form) {
    case Form::linear:
      return "linear";
    case Form::logarithmic:
      return "logarithmic";
    case Form::bounded:
      return "bounded";
  }
  return "";
}

double Unknown::to_state(double physical) const {
  const bool allowed = form == Form::linear        ? std::isfinite(physical)
                       : form == Form::logarithmic ? physical > 0.0 && std::isfinite(physical)
                                                   : physical > lower && physical < upper;
  if (!allowed)
    throw std::invalid_argument(
        form == Form::bounded ? fmt::format("{} is {:g}; expected a number between its bounds {:g} and {:g}",
                                            name, physical, lower, upper)
                              : fmt::format("{} is {:g}; expected a {} number", name, physical,
                                            form == Form::linear ? "finite" : "positive"));
  if (form == Form::linear) return physical;
  if (form == Form::logarithmic) return std::log(physical);
  return std::log((physical - lower) / (upper - physical));
}

double Unknown::to_physical(double state) const {
  if (form == Form::linear) return state;
  if (form == Form::logarithmic) return std::exp(state);
  return lower + (upper - lower) / (1.0 + std::exp(-state));
}

double Unknown::slope(double state) const {
  if (form == Form::linear) return 1.0;
  if (form == Form::logarithmic) return std::exp(state);
  const double share = 1.0 / (1.0 + std::exp(-state));
  return (upper - lower) * share * (1.0 - share);
}

namespace {

// Laws of springs bring theirs: a new law is one new file.
void add_quantities_of_springs(std::vector<ParameterQuantity>& all) {
  for (const auto& [name, entry] : spring_law_registry().entries())
    for (const SpringParameter& parameter : spring_law_registry().make(name, {})->parameters())
      if (std::none_of(all.begin(), all.end(),
                       [&](const ParameterQuantity& known) { return known.name == parameter.quantity.name; }))
        all.push_back(parameter.quantity);
}

// Whether two choices would move the same thing.
bool meet(const ParameterChoice& a, const ParameterChoice& b) {
  if (a.quantity != b.quantity || a.mode != b.mode) return false;
  if (a.quantity == "factor") return a.name == b.name;
  if (!a.region || !b.region) return true;
  return a.region->first < b.region->second && b.region->first < a.region->second;
}

}  // namespace

const std::vector<ParameterQuantity>& parameter_quantities() {
  static const std::vector<ParameterQuantity> quantities = [] {
    std::vector<ParameterQuantity> all{{"bending_stiffness", "N m2", "n_m2", true},
                                       {"tip_mass", "kg", "kg", true},
                                       {"body_mass", "kg", "kg", true},
                                       {"tip_rotary_inertia", "kg m2", "kg_m2", true},
                                       {"root_rotational_stiffness", "N m/rad", "n_m_per_rad", true},
                                       {"root_translational_stiffness", "N/m", "n_per_m", true},
                                       {"axial_load", "N", "n"},
                                       {"storey_stiffness", "N/m", "n_per_m", true},
                                       {"storey_damping", "N s/m", "n_s_per_m", true},
                                       {"factor", "", "", true},
                                       {"damping_ratio", "", "", true},
                                       {"mass_damping", "1/s", "per_s", true},
                                       {"stiffness_damping", "s", "s", true},
                                       {"frequency", "Hz", "hz", true},
                                       {"stiffness", "N/m", "n_per_m", true},
                                       {"damping", "N s/m", "n_s_per_m", true},
                                       {"mass", "kg", "kg", true},
                                       {"coulomb_friction", "N", "n"},
                                       {"quadratic_damping", "N s2/m2", "n_s2_per_m2"}};
    add_quantities_of_springs(all);
    return all;
  }();
  return quantities;
}

const ParameterQuantity& parameter_quantity(const std::string& name) {
  std::vector<std::string> names;
  for (const ParameterQuantity& quantity : parameter_quantities()) {
    if (quantity.name == name) return quantity;
    names.push_back(quantity.name);
  }
  throw std::invalid_argument("unknown quantity '" + name + "'; known: " + joined(names));
}

void refuse(const ParameterChoice& choice, const std::string& message) {
  if (choice.place.file.empty()) throw std::invalid_argument(message);
  throw InputError(choice.place, message);
}

void require_quantity(const ParameterChoice& choice, const std::vector<std::string>& known,
                      const std::string& model) {
  if (std::find(known.begin(), known.end(), choice.quantity) == known.end())
    refuse(choice, fmt::format("model '{}' has no parameter '{}'; its parameters are {}", model,
                               choice.quantity, joined(known)));
  const std::string& asked = choice.quantity;
  if (choice.region && asked != "bending_stiffness" && asked != "body_mass" && asked != "storey_stiffness" &&
      asked != "storey_damping")
    refuse(choice, asked +
                       " has no regions; expected bending_stiffness, body_mass, storey_stiffness or "
                       "storey_damping, or no from_m and to_m");
  if (choice.mode && choice.quantity != "damping_ratio" && choice.quantity != "frequency")
    refuse(choice, choice.quantity + " belongs to no mode; expected damping_ratio or frequency, or no mode");
}

Unknown unknown_of(const ParameterChoice& choice, const ParameterDefault& by_model) {
  const ParameterQuantity& quantity = parameter_quantity(choice.quantity);
  const std::string end = quantity.suffix.empty() ? "" : "_" + quantity.suffix;
  Unknown unknown;
  unknown.name = !choice.name.empty() ? choice.name
                 : choice.mode        ? fmt::format("{}_{}", choice.quantity, *choice.mode)
                                      : choice.quantity;
  unknown.unit = quantity.unit;
  unknown.quantity = choice.quantity;
  unknown.region = choice.region;
  unknown.mode = choice.mode;
  unknown.nuisance = choice.known;
  unknown.guess = choice.guess.value_or(by_model.guess);
  const double relative = choice.relative_deviation.value_or(by_model.relative_deviation);
  unknown.deviation = choice.deviation.value_or(relative * std::abs(unknown.guess));
  if (!(unknown.deviation > 0.0 && std::isfinite(unknown.deviation)))
    refuse(choice, fmt::format("{} is guessed as {:g}, which gives no measure of how uncertain it is; "
                               "expected deviation{} or another guess{}",
                               unknown.name, unknown.guess, end, end));
  if (choice.lower.has_value() != choice.upper.has_value())
    refuse(choice, fmt::format("{} has one bound; expected both lower{} and upper{}, or none", unknown.name,
                               end, end));
  const bool logarithmic = choice.keep_positive && quantity.positive && !choice.known && unknown.guess > 0.0;
  unknown.form = choice.form.value_or(choice.lower  ? Form::bounded
                                      : logarithmic ? Form::logarithmic
                                                    : Form::linear);
  if ((unknown.form == Form::bounded) != choice.lower.has_value())
    refuse(choice, fmt::format("{} is of form {} {} bounds; expected bounds with the form bounded, and with "
                               "no other",
                               unknown.name, to_string(unknown.form), choice.lower ? "with" : "without"));
  if (choice.lower) {
    unknown.lower = *choice.lower;
    unknown.upper = *choice.upper;
    if (!(unknown.lower < unknown.upper))
      refuse(choice, fmt::format("{} has the bounds {:g} and {:g}; expected the lower below the upper",
                                 unknown.name, unknown.lower, unknown.upper));
  }
  try {
    unknown.to_state(unknown.guess);
  } catch (const std::invalid_argument& error) {
    refuse(choice, error.what());
  }
  return unknown;
}

std::vector<Unknown> unknowns_of(const std::vector<ParameterChoice>& choices,
                                 const std::vector<ParameterDefault>& by_model) {
  std::vector<Unknown> unknowns;
  std::map<std::string, int> count, number;
  for (std::size_t j = 0; j < choices.size(); ++j) {
    unknowns.push_back(unknown_of(choices[j], by_model[j]));
    ++count[unknowns[j].name];
    for (std::size_t i = 0; i < j; ++i)
      if (meet(choices[i], choices[j]))
        refuse(choices[j], fmt::format("{} is requested twice{}", choices[j].quantity,
                                       choices[j].region ? ": its regions overlap" : ""));
  }
  for (std::size_t j = 0; j < choices.size(); ++j) {
    if (count[unknowns[j].name] < 2) continue;
    if (!choices[j].name.empty())
      refuse(choices[j], "two parameters are called " + unknowns[j].name + "; expected different names");
    unknowns[j].name += fmt::format("_{}", ++number[choices[j].quantity]);
  }
  return unknowns;
}

}  // namespace beamid::experiments
