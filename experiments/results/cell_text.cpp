#include "experiments/results/cell_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace beamid::experiments {
namespace {

// What is printed as zero has no sign.
std::string without_sign_of_zero(std::string text) {
  const bool is_zero =
      text.find('0') != std::string::npos && text.find_first_of("123456789") == std::string::npos;
  if (is_zero && (text.front() == '-' || text.front() == '+')) text.erase(0, 1);
  return text;
}

}  // namespace

std::string rounded_text(const Rounded& number) {
  constexpr double large = 1e6, small = 1e-5;
  constexpr int two_digits = 1, most = 12;
  const double size = std::abs(number.value);
  if (std::isnan(size)) return "-";
  if (!(number.uncertainty > 0.0) || !std::isfinite(number.uncertainty))
    return fmt::format("{:.6g}", number.value);
  const int last = static_cast<int>(std::floor(std::log10(number.uncertainty))) - two_digits;
  if (size == 0.0 || (size >= small && size < large))
    return without_sign_of_zero(fmt::format("{:.{}f}", number.value, std::clamp(-last, 0, most)));
  const int digits = static_cast<int>(std::floor(std::log10(size))) - last + 1;
  return fmt::format("{:.{}g}", number.value, std::clamp(digits, 2, most));
}

std::string cell_text(const Column& column, const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* number = std::get_if<Rounded>(&cell)) return rounded_text(*number);
  const double value = std::get<double>(cell);
  if (std::isnan(value)) return "-";
  try {
    return without_sign_of_zero(fmt::format(fmt::runtime(column.format), value));
  } catch (const fmt::format_error& error) {
    throw std::invalid_argument("column '" + column.key + "': format '" + column.format +
                                "': " + error.what());
  }
}

}  // namespace beamid::experiments
