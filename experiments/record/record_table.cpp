#include "experiments/record/record_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <regex>

#include "experiments/text/fields.hpp"

namespace beamid::experiments {

std::string count_of_columns(std::size_t count) {
  return fmt::format("{} column{}", count, count == 1 ? "" : "s");
}

InputError number_fault(const TextField& found, std::size_t column) {
  constexpr std::size_t longest = 40;
  const std::string shown =
      found.text.empty() ? "nothing" : fmt::format("'{}'", found.text.substr(0, longest));
  static const std::regex thousands(R"([-+]?[0-9]{1,3}([,.' ][0-9]{3})+([.,][0-9]+)?)");
  const char* expected = std::regex_match(found.text.substr(0, longest), thousands)
                             ? "a number without separators of thousands"
                         : parse_number(found.text).number ? "a finite number within double precision"
                         : found.text.find(',') != std::string::npos ? "a number with a decimal point"
                                                                     : "a number";
  return {found.place, fmt::format("column {} holds {}; expected {}", column + 1, shown, expected)};
}

Place RecordTable::place(std::size_t row, std::size_t column) const {
  return cell ? cell(row, column).place : Place{file, 0, 0};
}

Place RecordTable::row_place(std::size_t row) const {
  return row < lines.size() ? Place{file, lines[row], 1} : Place{file, 0, 0};
}

InputError RecordTable::fault(std::size_t row, std::size_t column) const {
  if (!cell)
    return InputError({file, 0, 0}, fmt::format("sample {} of {} is {}; expected a finite number", row + 1,
                                                column < names.size() ? "'" + names[column] + "'"
                                                                      : fmt::format("column {}", column + 1),
                                                columns[column][row]));
  return number_fault(cell(row, column), column);
}

void RecordTable::keep(const std::vector<bool>& kept) {
  const auto compact = [&](auto& values) {
    std::size_t next = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (kept[i]) values[next++] = values[i];
    values.resize(next);
  };
  for (std::vector<double>& column : columns) compact(column);
  if (!lines.empty()) compact(lines);
  if (!cell) return;
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (kept[i]) rows.push_back(i);
  cell = [before = cell, rows](std::size_t row, std::size_t column) { return before(rows[row], column); };
}

std::string skipped_text(const std::vector<std::size_t>& lines, const std::string& why) {
  if (lines.empty()) return "";
  constexpr std::size_t most = 5;
  std::string places;
  for (std::size_t i = 0; i < std::min(lines.size(), most); ++i)
    places += (i ? ", " : "") + std::to_string(lines[i]);
  if (lines.size() > most) places += ", ...";
  return lines.size() == 1
             ? fmt::format("1 line is left out, as it {}: line {}.", why, places)
             : fmt::format("{} lines are left out, as each {}: lines {}.", lines.size(), why, places);
}

}  // namespace beamid::experiments
