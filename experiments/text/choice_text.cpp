#include "experiments/text/choice_text.hpp"

#include <fmt/format.h>

#include <optional>

#include "experiments/text/words.hpp"

namespace beamid::experiments {

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
