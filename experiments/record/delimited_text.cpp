#include "experiments/record/delimited_text.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "experiments/record/recognised_column.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/record/stamps.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {

bool is_reading(std::string_view field) {
  return parse_number(field).number || parse_number(field, ',').number || parse_stamp(unquoted(field));
}

bool holds_reading(const std::vector<std::string_view>& fields) {
  return std::ranges::any_of(fields, is_reading);
}

bool is_row(const std::vector<std::string_view>& fields, bool with_gaps) {
  bool read = false;
  for (const std::string_view field : fields) {
    const bool reading = is_reading(field);
    if (!reading && !(with_gaps && says_missing(field))) return false;
    read = read || reading;
  }
  return read;
}

bool is_key_and_value(const std::vector<std::string_view>& fields) {
  static const std::set<std::string> keys{
      "device",         "units",          "unit",       "range",        "gain",
      "serialnumber",   "serial",         "sn",         "date",         "start",
      "starttime",      "startdate",      "end",        "endtime",      "model",
      "sensor",         "operator",       "channels",   "samples",      "version",
      "firmware",       "file",           "filename",   "project",      "comment",
      "comments",       "notes",          "note",       "test",         "testname",
      "location",       "sensitivity",    "scale",      "mode",         "name",
      "title",          "station",        "instrument", "duration",     "numberofsamples",
      "samplecount",    "points",         "deviceid",   "measurement",  "datetime",
      "created",        "author",         "customer",   "messbereich",  "einheit",
      "datum",          "modell",         "sensortype", "type",         "bandwidth",
      "resolution",     "filter",         "fullscale",  "recordlength", "verticalscale",
      "verticaloffset", "horizontalscale"};
  if (fields.size() != 2 || is_reading(fields[0]) || fields[0].empty()) return false;
  std::string name = folded(unquoted(fields[0]).substr(0, unquoted(fields[0]).find_first_of("[(")));
  if (sampling_name(name) != SamplingName::none && is_reading(fields[1])) return true;
  std::erase_if(name, [](char c) { return c == ' ' || c == '_' || c == '-' || c == ':' || c == '.'; });
  static const std::set<std::string> names_too{"date",   "datetime", "datum",       "start", "samples",
                                               "points", "created",  "measurement", "test"};
  const auto named = recognise_column(std::string(unquoted(fields[1])), "");
  const bool names = named && named->kind == RecognisedColumn::Kind::signal && named->states_quantity;
  return keys.contains(name) && !(names_too.contains(name) && names);  // "Date,strain"
}

KeyInFront key_in_front(const std::vector<std::string_view>& fields, std::size_t width) {
  static const std::set<std::string> names{"tracename", "channel", "title", "signal", "name"},
      units{"vunit", "unit", "units", "y unit", "y-unit", "einheit"};
  if (fields.size() != width || width < 2) return KeyInFront::none;
  std::string key = folded(unquoted(fields[0]));
  if (key.ends_with(':')) key.pop_back();
  return names.contains(key) ? KeyInFront::names : units.contains(key) ? KeyInFront::units : KeyInFront::none;
}

bool numbers_components(const std::vector<std::string_view>& fields) {
  int number = 0;
  bool sensor = false;  // the column before the numbers
  for (const std::string_view field : fields) {
    const std::string text(unquoted(field));
    if (sensor && text == std::to_string(number + 1)) {
      ++number;
      continue;
    }
    if (is_reading(text)) return false;
    const auto found = number == 0 ? recognise_column(text, "") : std::nullopt;
    sensor = found && found->kind == RecognisedColumn::Kind::signal && found->states_unit;
  }
  return number > 0;
}

void name_components(std::vector<std::string>& names) {
  static const std::regex axis(R"( ?\([xyz]\))"), component("[0-9]+");
  std::string sensor;
  for (std::string& name : names) {
    if (std::regex_match(name, component))
      name = name + ": " + sensor;  // the unit stays at the end
    else
      sensor = std::regex_replace(name, axis, "");
  }
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
  if (header_lines > 0)
    find_header(header_lines);
  else if (!find_body() && tolerant_)
    find_rows();
  else if (width_ == 0)
    find_header(0);
  first_row_pending_ = true;
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
  refuse_commas_between_commas();
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
    line = take_line(rest);
  }
  if (comma && !(thousands && whole)) decimal_ = ',';
}

// "0,0025,4,0031": halves of decimals keep their digits, and some begin with 0, as no whole numbers do.
void DelimitedText::refuse_commas_between_commas() const {
  constexpr int looked_at = 50;
  if (separator_ != ',' || width_ % 2 != 0) return;
  std::vector<std::size_t> digits;
  bool zero = false;
  std::string_view rest = rest_, line = line_;
  for (int row = 0; row < looked_at; ++row) {
    std::vector<std::string_view> fields;
    split_fields(line, ',', fields);
    if (fields.size() != width_) return;
    for (std::size_t k = 0; k < width_; ++k) {
      const std::string_view number = fields[k].substr(k % 2 == 0 && fields[k].starts_with('-') ? 1 : 0);
      if (number.empty() || number.find_first_not_of("0123456789") != number.npos) return;
      if (row == 0) digits.push_back(number.size());
      if (k % 2 == 0) continue;
      if (number.size() != digits[k] || number.size() < 2) return;
      zero = zero || number.front() == '0';
    }
    if (rest.empty()) break;
    line = take_line(rest);
  }
  if (zero)
    throw InputError(
        row_place(),
        "decimal commas between commas that part columns; expected decimal points, or semicolons "
        "or tabs between the columns");
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

// Of a tolerant walk.
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

      go_back_to(first, whole);
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
  throw InputError({file_, 0, 0},
                   "no two rows of numbers in succession; expected rows of numbers in columns");
}

bool DelimitedText::next_line() {
  if (rest_.empty()) return false;
  line_ = take_line(rest_);
  ++line_number_;
  return true;
}

void DelimitedText::go_back_to(const EarlyLine& line, std::string_view text) {
  rest_ = text.substr(static_cast<std::size_t>(line.text.data() - text.data()));
  line_ = take_line(rest_), line_number_ = line.number;
}

namespace {

/// A line between names and rows: "|------|-----:|", "-----+-----".
bool is_rule(std::string_view content) {
  return content.find_first_not_of("|-:+= \t") == content.npos && content.find("---") != content.npos;
}

/// "[4000 rows x 2 columns]" behind the rows.
bool is_count_in_brackets(std::string_view line) {
  const std::string_view content = trimmed(line);
  return content.starts_with('[') && content.ends_with(']') && content.find("rows") != content.npos;
}

}  // namespace

bool DelimitedText::next_row() {
  while (next_line()) {
    const std::string_view content = trimmed(line_);
    if (content.empty() || is_rule(content)) continue;
    if (!is_comment(content)) return true;
    if (width_ == 0 && comments_.size() < most_early_lines) comments_.push_back({content, line_number_});
  }
  return false;
}

std::vector<std::string_view> DelimitedText::named_with_date(std::string_view line) const {
  std::vector<std::string_view> names = named(line, width_);
  static const std::set<std::string_view> clocks{"GPST", "UTC",       "JST",     "GPS",
                                                 "Time", "Timestamp", "Datetime"};
  if (names.size() + 1 != width_ || !clocks.contains(names[0])) return names;
  std::vector<std::string_view> cells;
  split_fields(line_, separator_, cells);
  const auto date = parse_stamp(cells[0]), time = parse_stamp(cells[1]);
  const bool dated =
      date && time && date->kind == Stamp::Kind::date && time->kind == Stamp::Kind::time_of_day;
  const bool in_weeks = !dated && cells[0].size() == 4 && is_reading(cells[0]) && is_reading(cells[1]);
  if (!dated && !in_weeks) return names;
  names[0] = dated ? "time" : "tow [s]";
  names.insert(names.begin(), dated ? "date" : "week");
  return names;
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
    if (holds_reading(ahead.fields_) && !is_statement(ahead.line_) && !is_key_and_value(ahead.fields_) &&
        !is_count_in_brackets(ahead.line_))
      return false;
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
