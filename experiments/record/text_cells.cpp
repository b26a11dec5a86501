#include "experiments/record/text_cells.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "experiments/text/fields.hpp"

namespace beamid::experiments {

std::string_view TextCells::Rows::line(std::size_t row) const {
  return std::string_view(*text).substr(begins[row], lengths[row]);
}

std::size_t TextCells::Rows::number(std::size_t row) const {
  const auto after = std::upper_bound(runs.begin(), runs.end(), row,
                                      [](std::size_t at, const auto& run) { return at < run.first; });
  const auto& [first, number] = *std::prev(after);
  return number + (row - first);
}

TextCells::TextCells(std::string file, std::shared_ptr<const std::string> text)
    : rows_(std::make_shared<Rows>(Rows{std::move(file), std::move(text), {}, {}, {}})) {}

void TextCells::add(std::string_view line, std::size_t number) {
  constexpr std::size_t longest = std::numeric_limits<std::uint32_t>::max();
  const std::size_t row = rows_->begins.size();
  if (rows_->runs.empty() || number != rows_->runs.back().second + (row - rows_->runs.back().first))
    rows_->runs.emplace_back(row, number);
  rows_->begins.push_back(static_cast<std::size_t>(line.data() - rows_->text->data()));
  rows_->lengths.push_back(static_cast<std::uint32_t>(std::min(line.size(), longest)));
}

std::function<TextField(std::size_t, std::size_t)> TextCells::cells(char separator,
                                                                    std::vector<std::size_t> columns) const {
  return [rows = rows_, separator, columns = std::move(columns)](std::size_t row, std::size_t column) {
    const std::string_view line = rows->line(row);
    std::vector<std::string_view> fields;
    split_fields(line, separator, fields);
    const std::size_t at = columns.empty() ? column : columns[column];
    if (at >= fields.size()) split_fields(line, separator, fields, true);  // it may hold nothing
    if (at >= fields.size()) return TextField{{rows->file, rows->number(row), 1}, ""};
    const auto offset = static_cast<std::size_t>(fields[at].data() - line.data());
    return TextField{{rows->file, rows->number(row), offset + 1}, std::string(fields[at])};
  };
}

}  // namespace beamid::experiments
