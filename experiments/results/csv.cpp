#include "experiments/results/csv.hpp"

#include <cctype>
#include <fmt/format.h>

#include <cmath>

#include "experiments/text/clean_text.hpp"

namespace beamid::experiments {

std::string csv_field(std::string_view raw) {
  std::string text = clean_lines(raw);
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + '"';
}

std::string csv_field(double value) {
  return std::isnan(value) ? std::string() : fmt::format("{}", value);
}

std::string column_key(const std::string& name, const std::string& unit) {
  std::string key = name;
  if (!unit.empty()) key += "_";
  for (const char letter : unit) {
    if (letter == '/')
      key += "_per_";
    else
      key += letter == ' ' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  }
  return key;
}

}  // namespace beamid::experiments
