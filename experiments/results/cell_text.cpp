#include "experiments/results/cell_text.hpp"

#include <fmt/format.h>

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

std::string cell_text(const Column& column, const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
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
