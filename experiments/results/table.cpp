#include "experiments/results/table.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "experiments/text/fields.hpp"

namespace beamid::experiments {

const double* number_of(const Cell& cell) {
  if (const auto* rounded = std::get_if<Rounded>(&cell)) return &rounded->value;
  return std::get_if<double>(&cell);
}

Table& Table::column(Column column) {
  columns.push_back(std::move(column));
  return *this;
}

Table& Table::row(std::vector<Cell> cells) {
  if (cells.size() != columns.size())
    throw std::invalid_argument(
        fmt::format("table '{}': row of {} cells; expected {}", name, cells.size(), columns.size()));
  for (std::size_t i = 0; i < cells.size(); ++i) columns[i].cells.push_back(std::move(cells[i]));
  return *this;
}

std::size_t Table::rows() const {
  if (columns.empty()) return 0;
  const std::size_t count = columns.front().cells.size();
  for (const Column& column : columns)
    if (column.cells.size() != count)
      throw std::invalid_argument(fmt::format("table '{}': column '{}' has {} cells; expected {}", name,
                                              column.key, column.cells.size(), count));
  return count;
}

std::string to_csv(const Table& table) {
  const std::size_t rows = table.rows();
  std::string csv;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (i > 0) csv += ',';
    csv += csv_field(table.columns[i].key);
  }
  csv += '\n';
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      if (i > 0) csv += ',';
      const Cell& cell = table.columns[i].cells[row];
      const double* number = number_of(cell);
      csv += number ? csv_field(*number) : csv_field(std::get<std::string>(cell));
    }
    csv += '\n';
  }
  return csv;
}

}  // namespace beamid::experiments
