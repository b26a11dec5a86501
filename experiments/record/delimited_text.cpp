#include "experiments/record/delimited_text.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "experiments/record/recognised_column.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/record/stamps.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {
namespace {

constexpr std::size_t most_early_lines = 20000, most_header_lines = 4;
constexpr const char* rows_expected = "; expected rows of numbers in columns";

bool is_row(const std::vector<std::string_view>& fields, bool with_gaps) {
  bool read = false;
  for (const std::string_view field : fields) {
    const bool reading = is_reading(field);
    if (!reading && !(with_gaps && says_missing(field))) return false;
    read = read || reading;
  }
  return read;
}

bool holds_reading(const std::vector<std::string_view>& fields) {
  return std::ranges::any_of(fields, is_reading);
}

/// "Started:", "*STARTTIME", "[Start]": above a value of the file's head.
bool is_title(std::string_view line) {
  return line.ends_with(':') || line.starts_with('*') || (line.starts_with('[') && line.ends_with(']'));
}

/// "", "0", "1" or "0", "1", "2": what tables of pandas name columns without names.
bool counts_columns(const std::vector<std::string_view>& fields) {
  const std::size_t first = !fields.empty() && fields[0].empty() ? 1 : 0;
  for (std::size_t k = first; k < fields.size(); ++k)
    if (fields[k] != std::to_string(k - first)) return false;
  return fields.size() > 2 - first;
}

}  // namespace

bool is_reading(std::string_view field) {
  return parse_number(field).number || parse_number(field, ',').number || parse_stamp(unquoted(field));
}

std::string_view line_near(std::string_view text, double place) {
  const std::size_t from =
      text.find_first_of("\r\n", static_cast<std::size_t>(place * static_cast<double>(text.size())));
  std::string_view rest = from == text.npos ? text : text.substr(from);
  rest.remove_prefix(std::min(rest.find_first_not_of("\r\n \t"), rest.size()));
  return rest.substr(0, rest.find_first_of("\r\n"));
}

DelimitedText::DelimitedText(std::string file, std::string_view text, char separator, int header_lines,
                             char decimal, bool tolerant)
    : file_(std::move(file)), rest_(text), separator_(separator), decimal_(decimal), tolerant_(tolerant) {
  if (separator_ == '\0' && decimal_ != '.' && is_column_with_commas(text)) separator_ = ';', decimal_ = ',';
  const std::string_view typical = line_near(text, 0.5);
  semicolon_comments_ = separator_ != ';' && separator_of(typical) != ';';
  split_fields(typical, separator_ == '\0' ? separator_of(typical) : separator_, fields_);
  labelled_ = std::ranges::any_of(fields_, label_length) && std::ranges::all_of(fields_, [](auto field) {
                return label_length(field) > 0 || parse_stamp(field);
              });
  if (tolerant_ && header_lines == 0)
    find_rows();
  else if (header_lines > 0 || !find_body())
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
    header = line_, header_line_ = line_number_, comments_.clear();
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
  choose_separator();
  if (!header.empty())
    name_columns(header, header_line_);
  else
    take_comment();
}

bool DelimitedText::find_body() {
  DelimitedText found(*this);
  std::vector<EarlyLine> lines;
  std::vector<std::vector<std::string_view>> fields;
  std::size_t first = 0;
  for (bool two = false; !two;) {
    if (lines.size() == most_early_lines || !found.next_row()) return false;
    found.split(found.line_);
    if (!is_row(found.fields_, true) && separator_ == '\0') {  // "0,5 1,5": the commas are decimal
      std::vector<std::string_view> parted;
      split_fields(found.line_, ' ', parted);
      if (parted.size() > 1 && all_numbers(parted, ',')) found.fields_ = parted;
    }
    lines.push_back({found.line_, found.line_number_, found.fields_.size(), is_row(found.fields_, true)});
    fields.push_back(found.fields_);
    if (lines.size() < 2) continue;
    first = lines.size() - 2;
    two = lines[first].rows && lines[first + 1].rows && lines[first].width == lines[first + 1].width;
  }
  std::size_t width = lines[first].width;
  if (counts_columns(fields[first]) && first == 0 && !counts_columns(fields[1]) &&
      !std::ranges::all_of(fields[1], [](auto field) { return field.find_first_of(".,eE") == field.npos; })) {
    lines[0].rows = false;  // names
    first = 1;
  }
  const auto same_readings = [&](std::size_t line) {  // words beside the first rows are no header
    for (std::size_t k = 0; k < width; ++k)
      if (is_reading(fields[first][k]) && !is_reading(fields[line][k])) return false;
    return true;
  };
  while (first > 0 && lines[first - 1].width == width && same_readings(first - 1) &&
         !counts_columns(fields[first - 1]))
    --first;

  if (first > 0 && !holds_reading(fields[first - 1])) {  // the first rows may end in cells that hold nothing
    std::vector<std::string_view> cells;
    split_fields(lines[first].text, separator_of(lines[first - 1].text), cells, true);
    if (cells.size() > width && cells.size() == fields[first - 1].size()) width = cells.size();
  }
  const auto names_width = [&](std::size_t line) {
    const std::string_view text = lines[line].text;
    const bool titles = line > 0 && is_title(trimmed(text)) && lines[line - 1].text.find(':') != text.npos;
    return !titles && !(is_statement(text) && !labelled_) && named(text, width).size() == width &&
           (!holds_reading(fields[line]) || counts_columns(fields[line]));
  };
  const auto names = [&](std::size_t line) { return names_columns(named(lines[line].text, width)); };
  for (std::size_t k = 0; k < first; ++k) {
    const bool below_title = k > 0 && is_title(trimmed(lines[k - 1].text));
    if (lines[k].rows && !below_title && (lines[k].width == width || k + 1 == first)) return false;
  }
  std::optional<std::size_t> header, nearest;
  for (std::size_t k = first; k-- > 0 && first - k <= most_header_lines && !header;) {
    if (!names_width(k)) {
      if (holds_reading(fields[k]) && !is_statement(lines[k].text)) break;
      continue;
    }
    if (names(k)) header = k;
    if (!nearest && first - k <= 2) nearest = k;
  }
  if (first > 0 && holds_reading(fields[first - 1]) && !names_width(first - 1) &&
      !is_statement(lines[first - 1].text))
    for (std::size_t k = 0; k < first; ++k)  // a line between names and rows is one of the rows
      if (lines[first - 1].width == width || (names_width(k) && names(k))) return false;
  if (!header && nearest && *nearest > 0 && first - *nearest == 1 && names_width(*nearest - 1)) --*nearest;
  if (!header) header = nearest;
  if (!header && first > 0) {  // names of more or fewer columns than the rows have
    const char parted_by = separator_of(lines[first - 1].text);
    if (fields[first - 1].size() > 1 && !holds_reading(fields[first - 1]) &&
        !is_statement(lines[first - 1].text) && names_columns(fields[first - 1]) &&
        (parted_by != ' ' || separator_of(lines[first].text) == ' '))
      return false;
  }

  found.line_ = lines[first].text, found.line_number_ = lines[first].number;
  found.rest_ =
      rest_.substr(static_cast<std::size_t>(found.line_.data() + found.line_.size() - rest_.data()));
  found.rest_.remove_prefix(
      std::min(found.rest_.size(), std::size_t{found.rest_.starts_with("\r\n") ? 2u : 1u}));
  found.choose_separator();
  if (header) {
    const auto holds_units = [&](std::size_t line) {
      return line != *header && names_width(line) && are_units(named(lines[line].text, width));
    };
    std::size_t units = *header + 1;
    for (std::size_t k = first; k-- > (*header > 0 ? *header - 1 : 0);)
      if (holds_units(k)) units = k;
    if (units < first && names_width(units))
      for (const std::string_view unit : found.named(lines[units].text, width))
        found.units_.emplace_back(unquoted(unit));
    found.header_line_ = lines[*header].number;
    found.header_text_ = trimmed(lines[*header].text);
    found.name_columns(lines[*header].text, found.header_line_);
  } else {
    found.take_comment();
  }
  found.split_row();
  *this = std::move(found);
  return true;
}

std::vector<std::string_view> DelimitedText::named(std::string_view line, std::size_t width) const {
  std::vector<std::string_view> names;
  const char chosen = separator_ == '\0' ? separator_of(line) : separator_;
  for (const char separator : {chosen, '\t', ';', ',', '|'}) {
    split_fields(line, separator, names);
    for (std::string_view& name : names)  // "Time U(+); N(+)" above columns between blanks
      if (separator == ' ' && name.ends_with(';')) name.remove_suffix(1);
    if (names.size() == width && (separator == chosen || width > 1)) return names;
  }
  if (auto apart = parted_by_blanks(line); apart.size() == width && (width > 1 || chosen == ' '))
    return apart;
  split_fields(line, chosen, names);
  return names;
}

void DelimitedText::take_comment() {
  if (comments_.empty()) return;
  const auto fitting = std::find_if(comments_.rbegin(), comments_.rend(), [&](const Comment& comment) {
    std::vector<std::string_view> fields = named(words_of_comment(comment.text), width_);
    return fields.size() == width_ && !holds_reading(fields) && names_columns(fields);
  });
  const Comment& chosen = fitting == comments_.rend() ? comments_.back() : *fitting;
  name_columns(words_of_comment(chosen.text), header_line_ = chosen.line);
}

void DelimitedText::find_rows() {
  const std::string_view whole = rest_;
  for (const bool strict : {true, false}) {
    rest_ = whole, line_number_ = 0;
    std::vector<EarlyLine> before;
    while (next_row()) {
      split(line_);
      const bool row = strict ? is_row(fields_, false) : holds_number(fields_);
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
      const bool two = before.size() > 1 && names_width(before[before.size() - 2]);
      if (two) split_fields(before.back().text, separator_, fields_);
      if (two && !names_columns(fields_)) {
        for (const std::string_view field : fields_) units_.emplace_back(unquoted(field));
        before.pop_back();
      }
      if (!before.empty()) {
        header_line_ = before.back().number;
        name_columns(before.back().text, header_line_);
      } else {
        take_comment();
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
  constexpr int looked_at = 50;
  bool comma = false, thousands = true, whole = false;  // "998;999;1,000;1,001"
  std::string_view rest = rest_, line = line_;
  for (int row = 0; row < looked_at; ++row) {
    std::vector<std::string_view> fields;
    split_fields(line, separator_, fields);
    for (const std::string_view field : fields) {
      if (parse_stamp(field)) continue;
      if (field.find('.') != std::string_view::npos) return;
      const std::size_t at = field.find(',');
      whole = whole || (at == field.npos && parse_number(field).finite);
      if (at == field.npos || !parse_number(field, ',').finite) continue;
      comma = true;
      const std::size_t sign = field.starts_with('-') ? 1 : 0;
      thousands = thousands && field.size() - at == 4 && field[sign] != '0' && at > sign;
    }
    if (rest.empty()) break;
    const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
    line = rest.substr(0, end);
    rest.remove_prefix(std::min(rest.size(), end + 1));
  }
  if (comma && !(thousands && whole)) decimal_ = ',';
}

void DelimitedText::name_columns(std::string_view header, std::size_t line) {
  const bool comment = !comments_.empty() && line <= comments_.back().line &&
                       std::ranges::find(comments_, line, &Comment::line) != comments_.end();
  std::vector<std::string_view> fields = named(header, width_);
  if (comment && (fields.size() != width_ || holds_number(fields))) {
    header_line_ = 0;
    return;
  }
  if (fields.size() > width_) {  // cells at the end of the first row may hold nothing
    const std::size_t shown = std::exchange(width_, fields.size());
    split_row();
    if (fields_.size() != width_) width_ = shown;
  }
  if (fields.size() + 1 == width_) {  // the first column holds the names of rows
    split_row();
    if (fields_.size() == width_ && (fields_[0] == "1" || fields_[0] == "0")) names_.emplace_back();
  }
  for (const std::string_view field : fields) names_.emplace_back(unquoted(field));
}

std::string_view DelimitedText::words_of_comment(std::string_view comment) const {
  comment.remove_prefix(std::min(comment.find_first_not_of("#%!;/ \t"), comment.size()));
  for (const std::string_view title :
       {"Headers,", "Headers:", "Columns:", "columns:", "Names:", "DataSequence:", "Fields:"})
    if (comment.starts_with(title)) comment.remove_prefix(title.size());
  return comment;
}

void DelimitedText::split(std::string_view line) {
  split_fields(line, separator_ == '\0' ? separator_of(line) : separator_, fields_);
  if (labelled_) take_labels();
}

void DelimitedText::take_labels() {
  for (std::string_view& field : fields_) field = trimmed(field.substr(label_length(field)));
}

void DelimitedText::split_row() {
  split_fields(line_, separator_, fields_);
  if (labelled_) {
    if (names_.empty())
      for (const std::string_view field : fields_)
        names_.emplace_back(trimmed(field.substr(0, std::max<std::size_t>(label_length(field), 1) - 1)));
    take_labels();
  }
  if (fields_.size() >= width_ || separator_ == ' ') return;
  std::vector<std::string_view> all;
  split_fields(line_, separator_, all, true);
  while (all.size() > width_ && trimmed(all.back()).empty()) all.pop_back();
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
    if (!is_comment(content)) return true;
    if (width_ == 0 && comments_.size() < most_early_lines) comments_.push_back({content, line_number_});
  }
  return false;
}

bool DelimitedText::is_comment(std::string_view content) const {
  return content.front() == '#' || content.front() == '%' || content.front() == '!' ||
         content.starts_with("//") || (content.front() == ';' && semicolon_comments_);
}

bool DelimitedText::only_words_follow() const {
  constexpr std::size_t longest = 4096;
  if (rest_.size() > longest) return false;
  DelimitedText ahead(*this);
  std::size_t lines = 0;
  do {
    split_fields(ahead.line_, separator_, ahead.fields_);
    if (holds_reading(ahead.fields_)) return false;
  } while (++lines < most_early_lines && ahead.next_row());
  return true;
}

bool DelimitedText::next() {
  if (first_row_pending_) {
    first_row_pending_ = false;
    return true;
  }
  while (next_row()) {
    split_row();
    if (fields_.size() == width_ && (header_text_.empty() || trimmed(line_) != header_text_)) return true;
    const bool repeated = !header_text_.empty() && trimmed(line_) == header_text_;
    constexpr std::size_t fewest = 16;
    if (rest_.empty() && fields_.size() < width_ && line_number_ > header_line_ + fewest &&
        all_numbers(fields_, decimal_)) {
      for (const std::string_view field : fields_) short_end_.push_back(parse_number(field, decimal_).value);
    } else if (!tolerant_ && !repeated && !only_words_follow())
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
