#include "experiments/identify/stream/sample_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

namespace beamid::experiments {
namespace {

constexpr const char* line_blanks = " \t\r";

std::string_view trimmed_line(std::string_view field) {
  const std::size_t first = field.find_first_not_of(line_blanks);
  if (first == std::string_view::npos) return {};
  return field.substr(first, field.find_last_not_of(line_blanks) - first + 1);
}

double line_number_value(std::string_view field, const Place& place) {
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  const std::string_view text = trimmed_line(field);
  if (text.empty()) return missing;
  std::string_view digits = text;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0.0;
  const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || rest != digits.data() + digits.size())
    throw InputError(place, fmt::format("'{}'; expected a number, or nothing where none was measured", text));
  return value;
}

}  // namespace

filters::Sample read_sample(const std::string& line, Eigen::Index outputs, const Place& place) {
  const Eigen::Index found = 1 + std::count(line.begin(), line.end(), ',');
  if (found != outputs + 1)
    throw InputError(place, fmt::format("{} fields; expected {}: a time and {} output{}, parted by commas",
                                        found, outputs + 1, outputs, outputs == 1 ? "" : "s"));
  filters::Sample sample;
  sample.output.resize(outputs);
  std::size_t begin = 0;
  for (Eigen::Index i = 0; i <= outputs; ++i) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    const Place here{place.file, place.line, begin + 1};
    const double value = line_number_value(std::string_view(line).substr(begin, end - begin), here);
    if (i == 0 && !std::isfinite(value)) throw InputError(here, "no time; expected seconds");
    (i == 0 ? sample.time : sample.output[i - 1]) = value;
    begin = end + 1;
  }
  return sample;
}

}  // namespace beamid::experiments
