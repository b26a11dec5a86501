#include "experiments/results/cell_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace beamid::experiments {

std::string cell_text(const Column& column, const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  const double value = std::get<double>(cell);
  if (std::isnan(value)) return "-";
  try {
    return fmt::format(fmt::runtime(column.format), value);
  } catch (const fmt::format_error& error) {
    throw std::invalid_argument("column '" + column.key + "': format '" + column.format +
                                "': " + error.what());
  }
}

}  // namespace beamid::experiments
