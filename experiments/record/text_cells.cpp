#include "experiments/record/text_cells.hpp"

#include <utility>

#include "experiments/text/fields.hpp"

namespace beamid::experiments {

TextCells::TextCells(std::string file, std::shared_ptr<const std::string> text)
    : rows_(std::make_shared<Rows>(Rows{std::move(file), std::move(text), {}, {}})) {}

void TextCells::add(std::string_view line, std::size_t number) {
  rows_->lines.push_back(line);
  rows_->numbers.push_back(number);
}

std::function<TextField(std::size_t, std::size_t)> TextCells::cells(char separator,
                                                                    std::vector<std::size_t> columns) const {
  return [rows = rows_, separator, columns = std::move(columns)](std::size_t row, std::size_t column) {
    std::vector<std::string_view> fields;
    split_fields(rows->lines[row], separator, fields);
    const std::size_t at = columns.empty() ? column : columns[column];
    if (at >= fields.size()) split_fields(rows->lines[row], separator, fields, true);  // it may hold nothing
    if (at >= fields.size()) return TextField{{rows->file, rows->numbers[row], 1}, ""};
    const auto offset = static_cast<std::size_t>(fields[at].data() - rows->lines[row].data());
    return TextField{{rows->file, rows->numbers[row], offset + 1}, std::string(fields[at])};
  };
}

}  // namespace beamid::experiments
