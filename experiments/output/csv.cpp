#include "experiments/output/csv.hpp"

#include <fmt/format.h>

#include <cmath>

namespace beamid::experiments {

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + '"';
}

std::string csv_field(double value) {
  return std::isnan(value) ? std::string() : fmt::format("{}", value);
}

}  // namespace beamid::experiments
