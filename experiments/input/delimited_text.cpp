#include "experiments/input/delimited_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/input/fields.hpp"

namespace beamid::experiments {
std::string count_of_columns(std::size_t count) {
  return fmt::format("{} column{}", count, count == 1 ? "" : "s");
}

DelimitedText::DelimitedText(std::string file, std::string_view text, char separator, int header_lines)
    : file_(std::move(file)), rest_(text), separator_(separator) {
  std::string_view header;
  for (int skipped = 0; skipped < header_lines && next_line(); ++skipped)
    if (!trimmed(line_).empty()) header = line_, header_line_ = line_number_;
  const std::string missing = "no row of numbers" +
                              (header_lines > 0 ? fmt::format(" after {} header lines", header_lines) : "") +
                              "; expected rows of numbers in columns";
  if (!next_row()) throw InputError({file_, 0, 0}, missing);
  split_fields(line_, separator == '\0' ? separator_of(line_) : separator, fields_);
  if (header_lines == 0 && !holds_number(fields_)) {
    header = line_, header_line_ = line_number_, comment_ = {};
    if (!next_row()) throw InputError({file_, 0, 0}, missing);
    split_fields(line_, separator == '\0' ? separator_of(line_) : separator, fields_);
    if (!holds_number(fields_))
      throw InputError(
          row_place(),
          "a second row without numbers; expected one header line at most, or record.header_lines "
          "in the configuration");
  }
  if (header.empty()) header = comment_, header_line_ = comment_line_;
  if (separator == '\0') separator_ = separator_of(line_);
  split_fields(line_, separator_, fields_);
  width_ = fields_.size();
  first_row_pending_ = true;
  if (!header.empty()) name_columns(header, header_line_);
}

void DelimitedText::name_columns(std::string_view header, std::size_t line) {
  const bool comment = line == comment_line_;
  header = trimmed(header);
  header.remove_prefix(std::min(header.find_first_not_of("#% \t"), header.size()));
  std::vector<std::string_view> fields;
  split_fields(header, separator_, fields);
  if (fields.size() != width_) {
    std::vector<std::string_view> others;
    split_fields(header, separator_of(header), others);
    if (others.size() == width_) fields = others;
  }
  if (comment && fields.size() != width_) {
    header_line_ = 0;
    return;
  }
  for (const std::string_view field : fields) names_.emplace_back(unquoted(field));
}

bool DelimitedText::next_line() {
  if (rest_.empty()) return false;
  const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
  line_ = rest_.substr(0, end);
  rest_.remove_prefix(std::min(rest_.size(), end + (rest_.substr(end).starts_with("\r\n") ? 2 : 1)));
  ++line_number_;
  return true;
}

bool DelimitedText::next_row() {
  while (next_line()) {
    const std::string_view content = trimmed(line_);
    if (content.empty()) continue;
    if (content.front() != '#' && content.front() != '%') return true;
    comment_ = content, comment_line_ = line_number_;
  }
  return false;
}

bool DelimitedText::next() {
  if (first_row_pending_) {
    first_row_pending_ = false;
    return true;
  }
  if (!next_row()) return false;
  split_fields(line_, separator_, fields_);
  if (fields_.size() != width_)
    throw InputError(row_place(), fmt::format("{}; expected {} as in the first row",
                                              count_of_columns(fields_.size()), width_));
  return true;
}

Place DelimitedText::place(std::size_t column) const {
  return {file_, line_number_, static_cast<std::size_t>(fields_[column].data() - line_.data()) + 1};
}

double DelimitedText::number(std::size_t column) const {
  const std::string_view field = fields_[column];
  const ParsedNumber parsed = parse_number(field);
  if (parsed.finite) return parsed.value;
  constexpr std::size_t longest = 40;
  const std::string shown = field.empty() ? "nothing" : fmt::format("'{}'", field.substr(0, longest));
  const char* expected = parsed.number ? "a finite number within double precision"
                         : field.find(',') != std::string_view::npos ? "a number with a decimal point"
                                                                     : "a number";
  throw InputError(place(column),
                   fmt::format("column {} holds {}; expected {}", column + 1, shown, expected));
}

}  // namespace beamid::experiments
