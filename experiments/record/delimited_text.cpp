#include "experiments/record/delimited_text.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "experiments/record/recognised_column.hpp"
#include "experiments/record/record_table.hpp"
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

namespace {

constexpr std::size_t most_metadata_lines = 1000;
constexpr const char* rows_expected = "; expected rows of numbers in columns";

/// One of the two decimal signs makes all fields numbers.
bool numbers_throughout(const std::vector<std::string_view>& fields) {
  return all_numbers(fields, '.') || all_numbers(fields, ',');
}

}  // namespace

DelimitedText::DelimitedText(std::string file, std::string_view text, char separator, int header_lines,
                             char decimal, bool tolerant)
    : file_(std::move(file)), rest_(text), separator_(separator), decimal_(decimal), tolerant_(tolerant) {
  if (tolerant_ && header_lines == 0)
    find_rows();
  else if (header_lines > 0 || !find_behind_metadata())
    find_header(header_lines);
  first_row_pending_ = true;
}

void DelimitedText::find_header(int header_lines) {
  std::string_view header;
  for (int skipped = 0; skipped < header_lines && next_line(); ++skipped)
    if (!trimmed(line_).empty()) header = line_, header_line_ = line_number_;
  const std::string missing = "no row of numbers" +
                              (header_lines > 0 ? fmt::format(" after {} header lines", header_lines) : "") +
                              rows_expected;
  const auto holds = [&] {
    split_fields(line_, separator_ == '\0' ? separator_of(line_) : separator_, fields_);
    return holds_number(fields_) || holds_number(fields_, ',');
  };
  if (!next_row()) throw InputError({file_, 0, 0}, missing);
  if (header_lines == 0 && !holds()) {
    header = line_, header_line_ = line_number_, comment_ = {};
    if (!next_row()) throw InputError({file_, 0, 0}, missing);
    if (!holds()) {
      const std::vector<std::string_view> units = fields_;
      const std::string_view names = header, line_before = line_;
      const std::size_t line_before_number = line_number_;
      split_fields(names, separator_ == '\0' ? separator_of(names) : separator_, fields_);
      if (fields_.size() != units.size() || !next_row() || !holds())
        throw InputError(row_place(),
                         "a second row without numbers; expected names and units of the columns at most, or "
                         "record.header_lines in the configuration");
      if (names_columns(units))  // the first row was a title of as many fields
        header = line_before, header_line_ = line_before_number;
      else
        for (const std::string_view unit : units) units_.emplace_back(unquoted(unit));
    }
  }
  if (header.empty()) header = comment_, header_line_ = comment_line_;
  choose_separator();
  if (!header.empty()) name_columns(header, header_line_);
}

bool DelimitedText::find_behind_metadata() {
  DelimitedText found(*this);
  try {
    found.find_rows(most_metadata_lines);
  } catch (const InputError&) {  // no rows, or none so early
    return false;
  }
  const std::size_t header = (found.names_.empty() ? 0 : 1) + (found.units_.empty() ? 0 : 1);
  if (found.before_.size() < 2 || found.before_.size() == header) return false;
  for (const EarlyLine& line : found.before_) {
    if (found.header_line_ > 0 && line.number > found.header_line_ + (found.units_.empty() ? 0 : 1))
      return false;
    if (line.width == found.width_ && line.rows) return false;  // of numbers: refused as such
  }
  found.skipped_.clear();
  *this = std::move(found);
  return true;
}

void DelimitedText::find_rows(std::size_t most_lines) {
  const std::string_view whole = rest_;
  for (const bool strict : {true, false}) {
    rest_ = whole, line_number_ = 0;
    std::vector<EarlyLine> before;
    while (before.size() < most_lines && next_row()) {
      split_fields(line_, separator_ == '\0' ? separator_of(line_) : separator_, fields_);
      const bool row = strict ? numbers_throughout(fields_) : holds_number(fields_);
      before.push_back({line_, line_number_, fields_.size(), row});
      if (before.size() < 2) continue;
      const EarlyLine& last = before.back();
      const EarlyLine& first = before[before.size() - 2];
      if (!last.rows || !first.rows || last.width != first.width) continue;

      line_ = first.text, line_number_ = first.number;
      rest_ = whole.substr(static_cast<std::size_t>(first.text.data() + first.text.size() - whole.data()));
      rest_.remove_prefix(std::min(rest_.size(), std::size_t{rest_.starts_with("\r\n") ? 2u : 1u}));
      choose_separator();
      before.resize(before.size() - 2);
      before_ = before;
      const auto names_width = [&](const EarlyLine& line) {
        split_fields(line.text, separator_, fields_);
        return fields_.size() == width_ && !holds_number(fields_) && !holds_number(fields_, ',');
      };
      while (!before.empty() && !names_width(before.back())) {
        skipped_.insert(skipped_.begin(), before.back().number);
        before.pop_back();
      }
      if (before.empty())
        skipped_.clear();  // no names: what stands before the rows is a header of another kind
      const auto named = [&](const EarlyLine& line) {
        split_fields(line.text, separator_, fields_);
        return names_columns(fields_);
      };
      if (before.size() > 1 && names_width(before[before.size() - 2]) && !named(before.back())) {
        split_fields(before.back().text, separator_, fields_);
        for (const std::string_view field : fields_) units_.emplace_back(unquoted(field));
        before.pop_back();
      }
      if (!before.empty()) {
        header_line_ = before.back().number;
        name_columns(before.back().text, header_line_);
      } else if (!comment_.empty()) {
        header_line_ = comment_line_;
        name_columns(comment_, header_line_);
      }
      split_row();
      return;
    }
  }
  throw InputError({file_, 0, 0}, std::string("no two rows of numbers in succession") + rows_expected);
}

void DelimitedText::choose_separator() {
  const bool open = separator_ == '\0';
  if (open) separator_ = separator_of(line_);
  split_fields(line_, separator_, fields_);
  if (open && separator_ == ',' && decimal_ != '.' && !all_numbers(fields_)) {
    std::vector<std::string_view> parted;  // "0,5 1,5": the commas are decimal
    split_fields(line_, ' ', parted);
    if (parted.size() > 1 && all_numbers(parted, ',')) separator_ = ' ', fields_ = parted;
  }
  width_ = fields_.size();
  if (decimal_ != '\0') return;
  decimal_ = '.';
  if (separator_ == ',') return;
  constexpr int looked_at = 50;
  bool comma = false;
  std::string_view rest = rest_, line = line_;
  for (int row = 0; row < looked_at; ++row) {
    std::vector<std::string_view> fields;
    split_fields(line, separator_, fields);
    for (const std::string_view field : fields) {
      if (field.find('.') != std::string_view::npos) return;
      comma = comma || (field.find(',') != std::string_view::npos && parse_number(field, ',').finite);
    }
    if (rest.empty()) break;
    const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
    line = rest.substr(0, end);
    rest.remove_prefix(std::min(rest.size(), end + 1));
  }
  if (comma) decimal_ = ',';
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
  if (comment && (fields.size() != width_ || holds_number(fields))) {
    header_line_ = 0;
    return;
  }
  if (fields.size() > width_) {  // cells at the end of the first row may hold nothing
    const std::size_t shown = std::exchange(width_, fields.size());
    split_row();
    if (fields_.size() != width_) width_ = shown;
  }
  for (const std::string_view field : fields) names_.emplace_back(unquoted(field));
}

void DelimitedText::split_row() {
  split_fields(line_, separator_, fields_);
  if (fields_.size() >= width_ || separator_ == ' ') return;
  std::vector<std::string_view> all;
  split_fields(line_, separator_, all, true);
  if (all.size() == width_) fields_ = std::move(all);
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
  while (next_row()) {
    split_row();
    if (fields_.size() == width_) return true;
    if (!tolerant_)
      throw InputError(row_place(), fmt::format("{}; expected {} as in the first row",
                                                count_of_columns(fields_.size()), width_));
    skipped_.push_back(line_number_);
  }
  return false;
}

Place DelimitedText::place(std::size_t column) const {
  return {file_, line_number_, static_cast<std::size_t>(fields_[column].data() - line_.data()) + 1};
}

double DelimitedText::value(std::size_t column) const {
  const ParsedNumber parsed = parse_number(fields_[column], decimal_);
  return parsed.finite ? parsed.value : std::numeric_limits<double>::quiet_NaN();
}

double DelimitedText::number(std::size_t column) const {
  const ParsedNumber parsed = parse_number(fields_[column], decimal_);
  if (parsed.finite) return parsed.value;
  throw number_fault({place(column), std::string(fields_[column])}, column);
}

}  // namespace beamid::experiments
