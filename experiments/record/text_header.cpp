// Where the rows of a delimited text begin, and what names their columns.
#include <algorithm>
#include <optional>
#include <set>
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

/// With those at its end that hold nothing.
std::vector<std::string_view> cells_of(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  split_fields(line, separator == '\0' ? separator_of(line) : separator, cells, true);
  return cells;
}

/// Columns of the rows, where all across a text have as many; 0: they do not.
std::size_t width_across(std::string_view text, char separator) {
  std::size_t width = 0;
  const bool one = holds_across(text, [&](std::string_view line) {
    const auto cells = cells_of(line, separator);
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
    const bool of_sampling = sampling_name(above[k]) != SamplingName::none || folded(above[k]) == "start";
    if (!is_unit && is_reading(cells[k]) && !of_sampling) return {};
    if (is_unit && are_units({above[k]}) && !repeats) return {};
    const auto named = recognise_column(unquoted(above[k]), "");
    const auto counted = recognise_column(unquoted(cells[k]), "");  // "X" above "Sequence"
    names_times = names_times || (counted && counted->kind == RecognisedColumn::Kind::count) ||
                  (named && (named->kind == RecognisedColumn::Kind::time ||
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

/// The first rows of a text, and the lines above them that name their columns.
class DelimitedText::Body {
 public:
  explicit Body(const DelimitedText& text)
      : text_(text), found_(text), usual_(width_across(text.rest_, text.separator_)) {}

  bool find_first_rows();                   ///< false: there are none
  bool has_rows_above() const;              ///< of as many columns, or next to the first rows
  bool has_odd_line_above() const;          ///< between names and rows, one of the rows
  void find_header();                       ///< what names the columns
  void find_keyed_header();                 ///< where keys stand in front of names and units, or above them
  bool has_names_of_another_width() const;  ///< and no header
  DelimitedText taken() const;              ///< the text at its first row

 private:
  bool read_line();  ///< false: there is none
  bool is_in_head(const EarlyLine& row) const;
  void take_rows_above();
  void take_empty_cells();
  bool is_beside_first(std::size_t line) const;
  bool is_word_line_above() const { return first_ > 0 && !holds_reading(fields_[first_ - 1]); }
  bool may_name(std::size_t line) const;
  bool names(std::size_t line) const { return names_columns(text_.named(lines_[line].text, width_)); }
  std::vector<std::string_view> units_in(std::size_t line) const;
  std::optional<std::size_t> header_above_units() const;

  const DelimitedText& text_;
  DelimitedText found_;
  const std::size_t usual_;  ///< columns all across the text; 0: not one number of them
  std::vector<EarlyLine> lines_;
  std::vector<std::vector<std::string_view>> fields_;  ///< of the lines
  std::size_t first_ = 0, width_ = 0;                  ///< line of the first row; columns
  std::optional<std::size_t> header_, keyed_units_;    ///< lines
};

bool DelimitedText::Body::read_line() {
  if (lines_.size() == most_early_lines || !found_.next_row()) return false;
  found_.split(found_.line_);
  if (!is_row(found_.fields_, true) && text_.separator_ == '\0') {  // "0,5 1,5": the commas are decimal
    std::vector<std::string_view> parted;
    split_fields(found_.line_, ' ', parted);
    if (parted.size() > 1 && all_numbers(parted, ',')) found_.fields_ = parted;
  }
  // Below as many names as rows have cells, those at the end of a row may hold nothing.
  const char between = text_.separator_ == '\0' ? separator_of(found_.line_) : text_.separator_;
  const auto names_all = [&](const EarlyLine& line) {
    std::vector<std::string_view> names;
    split_fields(line.text, between, names);
    return names.size() == usual_ && !line.rows;
  };
  if (usual_ > 2 && found_.fields_.size() < usual_ && std::ranges::any_of(lines_, names_all))
    if (auto cells = cells_of(found_.line_, text_.separator_); cells.size() == usual_)
      found_.fields_ = std::move(cells);
  lines_.push_back({found_.line_, found_.line_number_, found_.fields_.size(), is_row(found_.fields_, true)});
  fields_.push_back(found_.fields_);
  return true;
}

// Of a head whose rows are other than those of the record, which words part from them.
bool DelimitedText::Body::is_in_head(const EarlyLine& row) const {
  if (usual_ == 0 || row.width == usual_ || cells_of(row.text, text_.separator_).size() == usual_)
    return false;
  DelimitedText ahead(found_);
  for (std::size_t k = 0; k < most_early_lines && ahead.next_row(); ++k) {
    ahead.split(ahead.line_);
    if (ahead.fields_.size() == usual_ && is_row(ahead.fields_, true)) return false;
    if (!holds_reading(ahead.fields_)) return true;
  }
  return false;
}

bool DelimitedText::Body::find_first_rows() {
  for (bool two = false; !two;) {
    if (!read_line()) return false;
    if (lines_.size() < 2) continue;
    first_ = lines_.size() - 2;
    two = lines_[first_].rows && lines_[first_ + 1].rows &&
          lines_[first_].width == lines_[first_ + 1].width && !is_in_head(lines_[first_]);
  }
  width_ = lines_[first_].width;
  take_rows_above();
  take_empty_cells();
  return true;
}

// Words beside numbers in the first rows are no header; numbers that count the columns are one.
void DelimitedText::Body::take_rows_above() {
  const auto is_whole = [](std::string_view field) { return field.find_first_of(".,eE") == field.npos; };
  if (counts_columns(fields_[first_]) && first_ == 0 && !counts_columns(fields_[1]) &&
      !std::ranges::all_of(fields_[1], is_whole)) {
    lines_[0].rows = false;  // names
    first_ = 1;
  }
  while (first_ > 0 && lines_[first_ - 1].width == width_ && is_beside_first(first_ - 1) &&
         !counts_columns(fields_[first_ - 1]))
    --first_;
}

bool DelimitedText::Body::is_beside_first(std::size_t line) const {
  if (fields_[first_][0].empty() && !fields_[line][0].empty()) return false;  // a key before its values
  for (std::size_t k = 0; k < width_; ++k)
    if (is_reading(fields_[first_][k]) && !is_reading(fields_[line][k])) return false;
  return true;
}

// The first rows may end in cells that hold nothing.
void DelimitedText::Body::take_empty_cells() {
  if (!is_word_line_above() &&
      (first_ == 0 || fields_[first_ - 1].empty() || is_reading(fields_[first_ - 1][0])))
    return;
  const std::size_t count = cells_of(lines_[first_].text, separator_of(lines_[first_ - 1].text)).size();
  if (count > width_ && count == fields_[first_ - 1].size()) width_ = count;
}

bool DelimitedText::Body::may_name(std::size_t line) const {
  const std::string_view text = lines_[line].text;
  if (is_pair(text) && !text_.labelled_) return false;  // "Station: ABC", "Units: g"
  if (width_ == 2 && is_key_and_value(fields_[line]) && !text_.labelled_) return false;
  const bool titles = line > 0 && is_title(trimmed(text)) && lines_[line - 1].text.find(':') != text.npos;
  return !titles && !(is_statement(text) && !text_.labelled_) && text_.named(text, width_).size() == width_ &&
         (!holds_reading(fields_[line]) || counts_columns(fields_[line]) ||
          numbers_components(fields_[line]));
}

std::vector<std::string_view> DelimitedText::Body::units_in(std::size_t line) const {
  std::vector<std::string_view> cells = text_.named(lines_[line].text, width_);
  if (cells.size() < width_) cells = cells_of(lines_[line].text, separator_of(lines_[line].text));
  while (cells.size() > width_ && trimmed(cells.back()).empty()) cells.pop_back();
  if (lines_[line].rows || cells.size() != width_) return {};
  if (folded(unquoted(cells[0])) == "x unit") return {};  // a key
  if (are_units(cells)) return cells;
  return line > 0 ? units_among(cells, text_.named(lines_[line - 1].text, width_))
                  : std::vector<std::string_view>();
}

bool DelimitedText::Body::has_rows_above() const {
  for (std::size_t k = 0; k < first_; ++k) {
    const bool below_title = k > 0 && is_title(trimmed(lines_[k - 1].text));
    if (is_word_line_above() && (fields_[k].empty() || fields_[k][0].empty()))
      continue;  // below names of bodies, above those of axes
    if (lines_[k].rows && !below_title && (lines_[k].width == width_ || k + 1 == first_)) return true;
  }
  return false;
}

bool DelimitedText::Body::has_odd_line_above() const {
  if (first_ == 0 || is_word_line_above() || may_name(first_ - 1) || is_statement(lines_[first_ - 1].text) ||
      !units_in(first_ - 1).empty())
    return false;
  if (fields_[first_][0].empty() && !fields_[first_ - 1].empty() && !fields_[first_ - 1][0].empty())
    return false;  // a key
  const auto is_key = [](const auto& fields) { return fields.size() == 2 && !is_reading(fields[0]); };
  if (width_ == 2 &&
      std::all_of(fields_.begin(), fields_.begin() + static_cast<std::ptrdiff_t>(first_), is_key) &&
      (!names(0) || is_key_and_value(fields_[0])))
    return false;  // "SampleRate,100", "Gain,2.0"
  for (std::size_t k = 0; k < first_; ++k)
    if (lines_[first_ - 1].width == width_ || (may_name(k) && names(k))) return true;
  return false;
}

// Above units of all columns stand their names, be they numbers of channels.
std::optional<std::size_t> DelimitedText::Body::header_above_units() const {
  for (std::size_t k = first_; k-- > 1 && first_ - k <= most_header_lines;)
    if (width_ > 1 && !units_in(k).empty() && !lines_[k - 1].rows && units_in(k - 1).empty() &&
        text_.named(lines_[k - 1].text, width_).size() == width_)
      return k - 1;
  return {};
}

void DelimitedText::Body::find_header() {
  std::optional<std::size_t> nearest;
  header_ = header_above_units();
  for (std::size_t k = first_; k-- > 0 && first_ - k <= most_header_lines && !header_;) {
    if (!may_name(k)) {
      if (holds_reading(fields_[k]) && !is_statement(lines_[k].text)) break;
      continue;
    }
    if (names(k)) header_ = k;
    if (!nearest && first_ - k <= 2) nearest = k;
  }
  if (!header_ && nearest && *nearest > 0 && first_ - *nearest == 1 && may_name(*nearest - 1)) --*nearest;
  if (!header_) header_ = nearest;
  find_keyed_header();
}

// "TraceName","CH1"; "VUnit","V"; then rows that begin with a blank. "Title;Tip", "Y unit;g" above times
// without a name. "*CHANNEL" above names, "*UNIT" above units.
void DelimitedText::Body::find_keyed_header() {
  std::optional<std::size_t> names, units, titled_names, titled_units;
  for (std::size_t k = 0; k < first_; ++k) {
    const KeyInFront key = key_in_front(fields_[k], width_);
    if (key == KeyInFront::names) names = k;
    if (key == KeyInFront::units &&
        (fields_[first_][0].empty() || are_units({fields_[k].begin() + 1, fields_[k].end()})))
      units = k;
    const std::string title = folded(trimmed(lines_[k].text));
    if (k + 1 == first_ || fields_[k + 1].size() != width_) continue;
    if (title == "*channel") titled_names = k + 1;
    if (title == "*unit") titled_units = k + 1;
  }
  if (titled_names && titled_units) names = titled_names, units = titled_units;
  const bool blank = fields_[first_][0].empty();
  if (blank && names) header_ = names;
  if (blank && units) keyed_units_ = units;
  if (blank || !names || !units) return;
  const auto first = header_ ? recognise_column(unquoted(fields_[*header_][0]), "") : std::nullopt;
  if (first && (first->kind == RecognisedColumn::Kind::time || first->kind == RecognisedColumn::Kind::count))
    return;  // a header of its own
  header_ = names, keyed_units_ = units;
}

bool DelimitedText::Body::has_names_of_another_width() const {
  if (header_ || !is_word_line_above()) return false;
  const EarlyLine& above = lines_[first_ - 1];
  const std::vector<std::string_view>& fields = fields_[first_ - 1];
  return fields.size() > 1 && !is_statement(above.text) && names_columns(fields) &&
         (separator_of(above.text) != ' ' || separator_of(lines_[first_].text) == ' ');
}

DelimitedText DelimitedText::Body::taken() const {
  DelimitedText found(found_);
  found.go_back_to(lines_[first_], text_.rest_);
  found.choose_separator();
  if (header_) {
    std::vector<std::string_view> units;
    std::size_t last = *header_;  // of the lines that are understood
    for (std::size_t k = first_; k-- > (*header_ > 0 ? *header_ - 1 : 0);)
      if (auto cells = k == *header_ ? units : units_in(k); !cells.empty())
        units = std::move(cells), last = std::max(*header_, k);
    if (keyed_units_) units = fields_[*keyed_units_], units[0] = {};
    if (units.empty() && *header_ + 1 < first_ && may_name(*header_ + 1))
      units = found.named(lines_[*header_ + 1].text, width_), last = *header_ + 1;
    for (std::size_t k = last + 1; k < first_; ++k)
      if (text_.tolerant_ || (begins_with_digit(fields_[k]) && !is_statement(lines_[k].text)))
        found.skipped_.push_back(lines_[k].number);
    for (const std::string_view unit : units) found.units_.emplace_back(unquoted(unit));
    found.header_line_ = lines_[*header_].number;
    found.header_text_ = trimmed(lines_[*header_].text);
    found.name_columns(lines_[*header_].text, found.header_line_);
  } else {
    found.take_comment();
  }
  found.split_row();
  return found;
}

bool DelimitedText::find_body() {
  Body body(*this);
  if (!body.find_first_rows() || body.has_rows_above() || body.has_odd_line_above()) return false;
  body.find_header();
  if (body.has_names_of_another_width()) return false;
  *this = body.taken();
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
  std::erase_if(comments_, [&](const Comment& comment) {  // "Sample rate: 100 Hz", above one column
    return width_ == 1 && words_of_comment(comment.text).find_first_of(":=") != std::string_view::npos;
  });
  if (comments_.empty()) return;
  const auto fitting = std::find_if(comments_.rbegin(), comments_.rend(), [&](const Comment& comment) {
    std::vector<std::string_view> fields = named_with_date(words_of_comment(comment.text));
    return fields.size() == width_ && !holds_reading(fields) && names_columns(fields);
  });
  const Comment& chosen = fitting == comments_.rend() ? comments_.back() : *fitting;
  name_columns(words_of_comment(chosen.text), header_line_ = chosen.line);
}

void DelimitedText::name_columns(std::string_view header, std::size_t line) {
  const bool comment = !comments_.empty() && line <= comments_.back().line &&
                       std::ranges::find(comments_, line, &Comment::line) != comments_.end();
  std::vector<std::string_view> fields = comment ? named_with_date(header) : named(header, width_);
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
  if (numbers_components(fields)) name_components(names_);
}

std::string_view DelimitedText::words_of_comment(std::string_view comment) const {
  comment.remove_prefix(std::min(comment.find_first_not_of("#%!;/ \t"), comment.size()));
  for (const std::string_view title :
       {"Headers,", "Headers:", "Columns:", "columns:", "Names:", "DataSequence:", "Fields:"})
    if (comment.starts_with(title)) comment.remove_prefix(title.size());
  return comment;
}

}  // namespace beamid::experiments
