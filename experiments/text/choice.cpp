#include "experiments/text/choice.hpp"

#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace beamid::experiments {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find(separator, begin);
    parts.push_back(text.substr(begin, end - begin));
    if (end == std::string::npos) return parts;
    begin = end + 1;
  }
}

std::optional<double> number(const std::string& word) {
  double value = 0.0;
  const char* const end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc() || rest != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string word_of(const filters::OptionValue& value) {
  if (const double* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const bool* truth = std::get_if<bool>(&value)) return *truth ? "true" : "false";
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return fmt::format("{}", fmt::join(std::get<std::vector<double>>(value), "/"));
}

using filters::OptionValue;

ChoiceWords split_choice(const std::string& text) {
  const std::size_t colon = text.find(':');
  ChoiceWords words{text.substr(0, colon), {}};
  if (colon == std::string::npos) return words;
  for (const std::string& word : split(text.substr(colon + 1), ',')) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos)
      throw std::invalid_argument(fmt::format(
          "'{}' after '{}'; expected OPTION=VALUE, as in modal_truncation:modes=3", word, words.name));
    words.options.emplace_back(word.substr(0, equals), word.substr(equals + 1));
  }
  return words;
}

OptionValue parse_value(const std::string& word, const filters::OptionSpec& option,
                        const std::string& owner) {
  const auto refuse = [&](const char* expected) {
    throw std::invalid_argument(
        fmt::format("option '{}' of {} is '{}'; expected {}", option.name, owner, word, expected));
  };
  if (std::holds_alternative<std::string>(option.fallback)) return word;
  if (std::holds_alternative<bool>(option.fallback)) {
    if (word != "true" && word != "false") refuse("true or false");
    return word == "true";
  }
  if (std::holds_alternative<double>(option.fallback)) {
    const std::optional<double> value = number(word);
    if (!value) refuse("a number");
    return *value;
  }
  std::vector<double> values;
  for (const std::string& part : split(word, '/')) {
    const std::optional<double> value = number(part);
    if (!value) refuse("numbers parted by '/', as 0.4/0.8/1.1");
    values.push_back(*value);
  }
  return values;
}

std::string choice_text(const Choice& choice, const std::vector<filters::OptionSpec>& specs) {
  std::string text = choice.name;
  char joint = ':';
  const auto add = [&](const std::string& name, const std::string& value) {
    text.append(1, joint).append(name).append("=").append(value);
    joint = ',';
  };
  for (const filters::OptionSpec& option : specs) {
    const auto given = choice.options.values().find(option.name);
    if (given != choice.options.values().end() && given->second != option.fallback)
      add(option.name, word_of(given->second));
  }
  if (!choice.shape_file.empty()) add("shape_file", choice.shape_file);
  return text;
}

}  // namespace beamid::experiments
