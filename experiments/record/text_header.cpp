// Where the rows of a delimited text begin, and what names their columns.
#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "experiments/record/delimited_text.hpp"
#include "experiments/record/recognised_column.hpp"
#include "experiments/record/stamps.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {
namespace {

constexpr std::size_t most_header_lines = 4;
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

/// "Started:", "*STARTTIME", "[Start]": above a value of the file's head.
bool is_title(std::string_view line) {
  return line.ends_with(':') || line.starts_with('*') || (line.starts_with('[') && line.ends_with(']'));
}

bool begins_with_digit(const std::vector<std::string_view>& fields) {
  return std::ranges::any_of(fields, [](std::string_view field) {
    return !field.empty() && field.front() >= '0' && field.front() <= '9';
  });
}

/// A key and a value, parted by a colon and blanks alone.
bool is_pair(std::string_view line) {
  const std::size_t colon = line.find(':');
  return colon != line.npos && colon > 0 && colon + 2 < line.size() && line[colon + 1] == ' ' &&
         line.find(':', colon + 1) == line.npos && line.find_first_of("\t,;|") == line.npos;
}

/// "", "0", "1" or "0", "1", "2": what tables of pandas name columns without names.
bool counts_columns(const std::vector<std::string_view>& fields) {
  const std::size_t first = !fields.empty() && fields[0].empty() ? 1 : 0;
  for (std::size_t k = first; k < fields.size(); ++k)
    if (fields[k] != std::to_string(k - first)) return false;
  return fields.size() > 2 - first;
}

/// Columns of the rows, where all across a text have as many; 0: they do not.
std::size_t width_across(std::string_view text, char separator) {
  std::size_t width = 0;
  const bool one = holds_across(text, [&](std::string_view line) {
    std::vector<std::string_view> cells;
    split_fields(line, separator == '\0' ? separator_of(line) : separator, cells, true);
    const std::size_t before = std::exchange(width, cells.size());
    return before == 0 || before == width;
  });
  return one ? width : 0;
}

/// Below a line with names of times or counts, one that repeats some of it and states two or more units, of a
/// third of the columns at least: "NO.,Time,ms,mV,V,A1234". @returns its units; empty: it is none such
std::vector<std::string_view> units_among(const std::vector<std::string_view>& cells,
                                          const std::vector<std::string_view>& above) {
  std::vector<std::string_view> units;
  std::size_t count = 0;
  bool names_times = false;
  for (std::size_t k = 0; k < cells.size() && k < above.size(); ++k) {
    const bool is_unit = are_units({cells[k]}), repeats = cells[k] == above[k];
    if (!is_unit && is_reading(cells[k])) return {};
    if (is_unit && are_units({above[k]}) && !repeats) return {};
    const auto named = recognise_column(unquoted(above[k]), "");
    names_times = names_times || (named && (named->kind == RecognisedColumn::Kind::time ||
                                            named->kind == RecognisedColumn::Kind::count));
    count += is_unit ? 1 : 0;
    units.push_back(is_unit ? cells[k] : std::string_view());
  }
  return names_times && count >= 2 && 3 * count >= cells.size() && cells.size() == above.size()
             ? units
             : std::vector<std::string_view>();
}

}  // namespace

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
  const std::size_t usual = width_across(rest_, separator_);
  // Of a head whose rows are other than those of the record, which words part from them.
  const auto is_in_head = [&](const EarlyLine& row) {
    std::vector<std::string_view> cells;
    split_fields(row.text, separator_ == '\0' ? separator_of(row.text) : separator_, cells, true);
    if (usual == 0 || row.width == usual || cells.size() == usual) return false;
    DelimitedText ahead(found);
    for (std::size_t k = 0; k < most_early_lines && ahead.next_row(); ++k) {
      ahead.split(ahead.line_);
      if (ahead.fields_.size() == usual && is_row(ahead.fields_, true)) return false;
      if (!holds_reading(ahead.fields_)) return true;
    }
    return false;
  };
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
    two = lines[first].rows && lines[first + 1].rows && lines[first].width == lines[first + 1].width &&
          !is_in_head(lines[first]);
  }
  std::size_t width = lines[first].width;
  if (counts_columns(fields[first]) && first == 0 && !counts_columns(fields[1]) &&
      !std::ranges::all_of(fields[1], [](auto field) { return field.find_first_of(".,eE") == field.npos; })) {
    lines[0].rows = false;  // names
    first = 1;
  }
  const auto same_readings = [&](std::size_t line) {  // words beside the first rows are no header
    if (fields[first][0].empty() && !fields[line][0].empty()) return false;  // a key before its values
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
    if (is_pair(text) && !labelled_) return false;  // "Station: ABC", "Units: g"
    const bool titles = line > 0 && is_title(trimmed(text)) && lines[line - 1].text.find(':') != text.npos;
    return !titles && !(is_statement(text) && !labelled_) && named(text, width).size() == width &&
           (!holds_reading(fields[line]) || counts_columns(fields[line]));
  };
  const auto names = [&](std::size_t line) { return names_columns(named(lines[line].text, width)); };
  const auto units_of = [&](std::size_t line) -> std::vector<std::string_view> {
    std::vector<std::string_view> cells = named(lines[line].text, width);
    if (cells.size() < width) split_fields(lines[line].text, separator_of(lines[line].text), cells, true);
    while (cells.size() > width && trimmed(cells.back()).empty()) cells.pop_back();
    if (lines[line].rows || cells.size() != width) return {};
    if (are_units(cells)) return cells;
    return line > 0 ? units_among(cells, named(lines[line - 1].text, width))
                    : std::vector<std::string_view>();
  };
  for (std::size_t k = 0; k < first; ++k) {
    const bool below_title = k > 0 && is_title(trimmed(lines[k - 1].text));
    if (lines[k].rows && !below_title && (lines[k].width == width || k + 1 == first)) return false;
  }
  std::optional<std::size_t> header, nearest;
  // Above units of all columns stand their names, be they numbers of channels.
  for (std::size_t k = first; k-- > 1 && first - k <= most_header_lines && !header;)
    if (width > 1 && !units_of(k).empty() && !lines[k - 1].rows && units_of(k - 1).empty() &&
        named(lines[k - 1].text, width).size() == width)
      header = k - 1;
  for (std::size_t k = first; k-- > 0 && first - k <= most_header_lines && !header;) {
    if (!names_width(k)) {
      if (holds_reading(fields[k]) && !is_statement(lines[k].text)) break;
      continue;
    }
    if (names(k)) header = k;
    if (!nearest && first - k <= 2) nearest = k;
  }
  const bool is_keyed = first > 0 && fields[first][0].empty() && !fields[first - 1][0].empty();
  if (first > 0 && !is_keyed && holds_reading(fields[first - 1]) && !names_width(first - 1) &&
      !is_statement(lines[first - 1].text))
    for (std::size_t k = 0; k < first; ++k)  // a line between names and rows is one of the rows
      if (lines[first - 1].width == width || (names_width(k) && names(k))) return false;
  if (!header && nearest && *nearest > 0 && first - *nearest == 1 && names_width(*nearest - 1)) --*nearest;
  if (!header) header = nearest;
  // "TraceName","CH1"; "VUnit","V"; then rows that begin with a blank.
  std::optional<std::size_t> keyed_units;
  for (std::size_t k = 0; k < first && fields[first][0].empty(); ++k) {
    const std::string key = folded(unquoted(fields[k][0]));
    if (fields[k].size() == width && key == "tracename") header = k;
    if (fields[k].size() == width && key == "vunit") keyed_units = k;
  }
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
    std::vector<std::string_view> units;
    std::size_t last = *header;  // of the lines that are understood
    for (std::size_t k = first; k-- > (*header > 0 ? *header - 1 : 0);)
      if (auto cells = k == *header ? units : units_of(k); !cells.empty())
        units = std::move(cells), last = std::max(*header, k);
    if (keyed_units) units = fields[*keyed_units], units[0] = {};
    if (units.empty() && *header + 1 < first && names_width(*header + 1))
      units = found.named(lines[*header + 1].text, width), last = *header + 1;
    for (std::size_t k = last + 1; k < first; ++k)
      if (tolerant_ || (begins_with_digit(fields[k]) && !is_statement(lines[k].text)))
        found.skipped_.push_back(lines[k].number);
    for (const std::string_view unit : units) found.units_.emplace_back(unquoted(unit));
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

}  // namespace beamid::experiments
