#include "experiments/config/read_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/config/read_attachments.hpp"
#include "experiments/config/useless_keys.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

constexpr int most_parameter_modes = 1000;
const std::vector<std::string> number_keys{"guess", "deviation", "lower", "upper"};

std::string with_suffix(const std::string& number, const std::string& suffix) {
  return suffix.empty() ? number : number + "_" + suffix;
}

std::optional<double> read_number(const TomlTable& table, const std::string& number,
                                  const ParameterQuantity& quantity) {
  std::vector<std::string> others;
  for (const ParameterQuantity& other : parameter_quantities())
    if (other.suffix != quantity.suffix) others.push_back(with_suffix(number, other.suffix));
  const std::string key = with_suffix(number, quantity.suffix);
  refuse_useless(table, others, "for the quantity " + quantity.name, key);
  return table.find_number(key, number == "deviation" ? Sign::positive : Sign::any);
}

Form read_form(const TomlTable& table, const std::string& name) {
  for (const Form form : {Form::linear, Form::logarithmic, Form::bounded})
    if (name == to_string(form)) return form;
  table.refuse("form", "linear, logarithmic or bounded");
}

ParameterChoice read_parameter(const TomlTable& table, double length) {
  std::vector<std::string> names;
  for (const ParameterQuantity& quantity : parameter_quantities()) names.push_back(quantity.name);
  const auto name = table.find_text("quantity", names);
  if (!name) table.miss("quantity", "one of " + joined(names));
  const ParameterQuantity& quantity = parameter_quantity(*name);

  ParameterChoice choice;
  choice.place = table.place();
  choice.quantity = *name;
  choice.name = table.find_text("name").value_or("");
  const auto plain = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  if (table.contains("name") &&
      (choice.name.empty() || choice.name.size() > 100 ||  // which files are named after
       !std::all_of(choice.name.begin(), choice.name.end(), plain)))
    table.refuse("name", "at most 100 small letters, digits and underscores, as in a key");
  if (table.contains("from_m") || table.contains("to_m")) {
    const double from = position_on_beam(table, "from_m", length);
    const double to = position_on_beam(table, "to_m", length);
    if (from >= to) table.refuse("to_m", fmt::format("a number above from_m, {}", from));
    choice.region = std::pair{from, to};
  }
  choice.mode = table.find_whole_number("mode", 1, most_parameter_modes);
  choice.guess = read_number(table, "guess", quantity);
  choice.deviation = read_number(table, "deviation", quantity);
  choice.lower = read_number(table, "lower", quantity);
  choice.upper = read_number(table, "upper", quantity);
  choice.relative_deviation = table.find_number("relative_deviation", Sign::positive);
  if (choice.deviation)
    refuse_useless(table, {"relative_deviation"}, "beside " + with_suffix("deviation", quantity.suffix),
                   "one of them");
  if (const auto form = table.find_text("form")) choice.form = read_form(table, *form);
  choice.known = table.find_truth("known").value_or(false);
  return choice;
}

}  // namespace

std::vector<ParameterChoice> read_parameters(const TomlTable& root, double length) {
  std::vector<ParameterChoice> choices;
  for (const TomlTable& table : root.find_tables("parameters"))
    choices.push_back(read_parameter(table, length));
  return choices;
}

std::vector<std::string> parameter_keys() {
  std::vector<std::string> keys{"quantity", "name", "from_m", "to_m",
                                "mode",     "form", "known",  "relative_deviation"};
  for (const std::string& number : number_keys)
    for (const ParameterQuantity& quantity : parameter_quantities())
      if (const std::string key = with_suffix(number, quantity.suffix);
          std::find(keys.begin(), keys.end(), key) == keys.end())
        keys.push_back(key);
  return keys;
}

}  // namespace beamid::experiments
