#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/text/fields.hpp"
#include "experiments/text/spelling.hpp"
#include "experiments/text/toml_node.hpp"

namespace beamid::experiments {
namespace {

const char* expected_number(Sign sign) {
  switch (sign) {
    case Sign::any:
      return "a number";
    case Sign::not_negative:
      return "zero or a positive number";
    case Sign::positive:
      return "a positive number";
  }
  return "";
}

/// No laboratory has numbers beyond these in SI units; squares and products of others leave double precision.
constexpr double largest_number = 1e30, smallest_number = 1e-100;

bool is_out_of_proportion(double value) {
  return std::abs(value) > largest_number || (value != 0 && std::abs(value) < smallest_number);
}

std::string expected_size(Sign sign) {
  return fmt::format("{} of a size from {:g} to {:g}", expected_number(sign), smallest_number,
                     largest_number);
}

/// Texts reach terminals, pages and the scripts of figures.
void refuse_control(const Place& place, const std::string& path, const std::string& text) {
  if (const std::size_t at = find_control(text); at != std::string::npos)
    throw InputError(place,
                     fmt::format("{} holds a control character (byte {} of the text, {:#04x}); expected "
                                 "a text of one line, without any",
                                 path, at + 1, static_cast<unsigned char>(text[at])));
}

}  // namespace

std::optional<double> TomlTable::find_number(const std::string& key, Sign sign) const {
  const toml::node* const node = node_->table->get(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_number()) refuse(key, expected_number(sign));
  const double value = *node->value<double>();
  if (!std::isfinite(value) || (sign == Sign::positive && value <= 0) ||
      (sign == Sign::not_negative && value < 0))
    refuse(key, std::isfinite(value) ? expected_number(sign) : "a finite number");
  if (is_out_of_proportion(value)) refuse(key, expected_size(sign));
  return value;
}

std::optional<int> TomlTable::find_whole_number(const std::string& key, int least, int most) const {
  const toml::node* const node = node_->table->get(key);
  if (node == nullptr) return std::nullopt;
  const auto* const value = node->as_integer();
  if (value == nullptr || value->get() < least || value->get() > most)
    refuse(key, fmt::format("a whole number from {} to {}", least, most));
  return static_cast<int>(value->get());
}

std::optional<std::string> TomlTable::find_text(const std::string& key) const {
  const toml::node* const node = node_->table->get(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_string()) refuse(key, "a text in quotes");
  refuse_control(value_place(key), path(key), node->as_string()->get());
  return node->as_string()->get();
}

std::optional<std::string> TomlTable::find_text(const std::string& key,
                                                const std::vector<std::string>& allowed) const {
  if (!contains(key)) return std::nullopt;
  if (!node_->table->get(key)->is_string()) refuse(key, "one of the texts " + joined(allowed));
  std::optional<std::string> value = find_text(key);
  if (std::find(allowed.begin(), allowed.end(), *value) == allowed.end())
    refuse(key, "one of " + joined(allowed));
  return value;
}

std::optional<std::pair<double, double>> TomlTable::find_interval(const std::string& key) const {
  const toml::node* const node = node_->table->get(key);
  if (node == nullptr) return std::nullopt;
  constexpr const char* expected = "two numbers [from, to], the first below the second";
  const toml::array* const array = node->as_array();
  if (array == nullptr || array->size() != 2) refuse(key, expected);
  const std::optional<double> from = array->get(0)->value<double>(), to = array->get(1)->value<double>();
  for (const toml::node& element : *array)
    if (!element.is_number() || !std::isfinite(*element.value<double>()))
      throw InputError(node_->at(element.source()),
                       fmt::format("{} holds {}; expected {}", path(key), found(element), expected));
  if (*from >= *to)
    throw InputError(value_place(key),
                     fmt::format("{} is [{}, {}]; expected {}", path(key), *from, *to, expected));
  return std::pair{*from, *to};
}

std::optional<bool> TomlTable::find_truth(const std::string& key) const {
  const toml::node* const node = node_->table->get(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_boolean()) refuse(key, "true or false");
  return node->as_boolean()->get();
}

std::optional<std::vector<double>> TomlTable::find_numbers(const std::string& key, Sign sign) const {
  const toml::node* const node = node_->table->get(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* const array = node->as_array();
  if (array == nullptr || array->empty()) refuse(key, "an array of at least one number");
  std::vector<double> numbers;
  for (const toml::node& element : *array) {
    const std::optional<double> value = element.is_number() ? element.value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value) || (sign == Sign::positive && *value <= 0) ||
        (sign == Sign::not_negative && *value < 0))
      throw InputError(node_->at(element.source()), fmt::format("{} holds {}; expected {}", path(key),
                                                                found(element), expected_number(sign)));
    if (is_out_of_proportion(*value))
      throw InputError(node_->at(element.source()), fmt::format("{} holds {}; expected {}", path(key),
                                                                found(element), expected_size(sign)));
    numbers.push_back(*value);
  }
  return numbers;
}

std::optional<std::vector<std::string>> TomlTable::find_texts(const std::string& key) const {
  const toml::node* const node = node_->table->get(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* const array = node->as_array();
  if (array == nullptr || array->empty()) refuse(key, "an array of at least one text");
  std::vector<std::string> texts;
  for (const toml::node& element : *array) {
    const auto text = element.value<std::string>();
    if (!text || !element.is_string())
      throw InputError(node_->at(element.source()),
                       fmt::format("{} holds {}; expected a text in quotes", path(key), found(element)));
    refuse_control(node_->at(element.source()), path(key), *text);
    texts.push_back(*text);
  }
  return texts;
}

std::optional<filters::OptionValue> TomlTable::find_value(const std::string& key) const {
  const toml::node* const node = node_->table->get(key);
  if (node == nullptr) return std::nullopt;
  if (node->is_string()) return *find_text(key);
  if (node->is_boolean()) return node->as_boolean()->get();
  if (node->is_array()) return *find_numbers(key, Sign::any);
  if (!node->is_number()) refuse(key, "a number, a text in quotes, true or false, or an array of numbers");
  return *find_number(key);
}

double TomlTable::number(const std::string& key, Sign sign) const {
  const std::optional<double> value = find_number(key, sign);
  if (!value) miss(key, expected_number(sign));
  return *value;
}

std::string TomlTable::text(const std::string& key) const {
  const std::optional<std::string> value = find_text(key);
  if (!value) miss(key, "a text in quotes");
  return *value;
}

}  // namespace beamid::experiments
