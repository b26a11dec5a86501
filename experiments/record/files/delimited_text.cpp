// Rows of numbers in columns: the text export of nearly every analyser.
#include "experiments/record/delimited_text.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/record/recognised_column.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/record/stamps.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

struct OtherKind {
  std::string_view beginning, found, remedy;
};
constexpr std::string_view save_as_csv = "state --reader spreadsheet, or save its sheet as CSV";
constexpr OtherKind other_kinds[] = {
    {"\xD0\xCF\x11\xE0", "a workbook of Excel (.xls)", save_as_csv},
    {"%PDF", "a PDF document", "export the numbers of the record as text"},
    {"\x1F\x8B", "compressed by gzip", "gunzip it"},
    {"BZh", "compressed by bzip2", "bunzip2 it"},
    {"\xFD"
     "7zXZ",
     "compressed by xz", "unxz it"},
    {"7z\xBC\xAF", "a 7z archive", "unpack it"},
    {"TDSm", "a TDMS file of National Instruments", "state --reader tdms"},
    {"PAR1", "a Parquet table", "write it as CSV or NumPy array (.npy)"},
    {"ARROW1", "an Arrow table", "write it as CSV or NumPy array (.npy)"},
    {"SQLite format 3", "an SQLite database", "export the table of the record as CSV"},
    {"MDF ", "an MDF file", "export it as CSV or MATLAB file"},
    {"ABCF", "an ABF file", "export it as CSV"}};

/// Files whose beginning shows that they are no text of numbers.
void refuse_other_kinds(const std::filesystem::path& file) {
  std::ifstream stream = open_input(file, "a record of numbers in columns");
  std::string beginning(4096, '\0');
  stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  beginning.resize(static_cast<std::size_t>(stream.gcount()));
  const auto refuse = [&](std::string_view found, std::string_view remedy) {
    throw InputError({file.string(), 0, 0},
                     fmt::format("{}; expected a record of numbers in columns: {}", found, remedy));
  };
  for (const OtherKind& kind : other_kinds)
    if (beginning.starts_with(kind.beginning)) refuse(kind.found, kind.remedy);
  if (beginning.starts_with("PK\x03\x04")) {
    const bool sheet = beginning.find("[Content_Types].xml") != beginning.npos ||
                       beginning.find("xl/") != beginning.npos ||
                       beginning.find("opendocument.spreadsheet") != beginning.npos;
    refuse(sheet ? "a workbook (.xlsx or .ods)" : "a zip archive", sheet ? save_as_csv : "unpack it");
  }
  const std::size_t start = beginning.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (start == beginning.npos) return;
  const std::string_view text = std::string_view(beginning).substr(start);
  if (text.starts_with("<")) refuse("a page or a document of XML", "export the numbers of the record as CSV");
}

using Json = nlohmann::ordered_json;

bool begins_as_json(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n\xEF\xBB\xBF"), text.size()));
  const std::size_t inside = std::min(text.find_first_not_of(" \t\r\n", 1), text.size());
  const std::string_view rest = text.substr(inside);
  return (text.starts_with("{") && (rest.starts_with("\"") || rest.starts_with("}"))) ||  // not "{System 1};"
         (text.starts_with("[") && (rest.starts_with("{") || rest.starts_with("[")));
}

/// Of a row, or of all columns: keys of objects within it are joined by points.
void take_scalars(const Json& value, const std::string& key, std::vector<std::pair<std::string, Json>>& found,
                  int depth = 0) {
  constexpr int deepest = 3;
  if (value.is_object() && depth < deepest)
    for (const auto& [name, inner] : value.items())
      take_scalars(inner, key.empty() ? name : key + "." + name, found, depth + 1);
  else if (!value.is_structured())
    found.emplace_back(key, value);
}

std::string cell_of(const Json& value) {
  std::string cell = value.is_string() ? value.get<std::string>() : value.is_null() ? "" : value.dump();
  std::ranges::replace_if(
      cell, [](char c) { return c == ',' || c == '"' || c == '\n' || c == '\r'; }, ' ');
  return cell;
}

/// An array of objects, of the names of the first, or of arrays. @returns an empty text where it is none
std::string text_of_rows(const Json& rows) {
  if (!rows.is_array() || rows.size() < 2) return {};
  std::string text;
  std::vector<std::pair<std::string, Json>> cells;
  std::vector<std::string> names;
  for (const Json& row : rows) {
    cells.clear();
    if (row.is_array())
      for (const Json& value : row) take_scalars(value, "", cells, 1);
    else
      take_scalars(row, "", cells);
    if (text.empty() && row.is_object()) {
      for (const auto& [name, value] : cells) names.push_back(name);
      for (const std::string& name : names) text += (text.empty() ? "" : ",") + cell_of(name);
      text += '\n';
    }
    for (std::size_t k = 0; k < std::max(names.size(), names.empty() ? cells.size() : 0); ++k) {
      const auto found = names.empty()
                             ? cells.begin() + static_cast<std::ptrdiff_t>(k)
                             : std::ranges::find(cells, names[k], [](const auto& one) { return one.first; });
      text += (k > 0 ? "," : "") + (found == cells.end() ? "" : cell_of(found->second));
    }
    text += '\n';
  }
  return text;
}

/// Names with arrays of equally many numbers, beside them numbers and words for all; or one array of rows.
std::string text_of_columns(const Json& object, int depth = 0) {
  constexpr int deepest = 3;
  std::vector<std::pair<std::string, const Json*>> columns;
  std::string above;
  for (const auto& [name, value] : object.items())
    if (!value.is_structured()) above += name + ": " + cell_of(value) + "\n";
  const Json* longest = nullptr;  // of arrays of rows
  for (const auto& [name, value] : object.items())
    if (value.is_array() && value.size() > 1 && value[0].is_structured() &&
        (!longest || value.size() > longest->size()))
      longest = &value;
  if (longest)
    if (const std::string inner = text_of_rows(*longest); !inner.empty()) return above + inner;
  for (const auto& [name, value] : object.items()) {
    if (value.is_array() && value.size() > 1 && !value[0].is_structured())
      columns.emplace_back(name, &value);
    else if (value.is_object() && columns.empty() && depth < deepest)
      if (const std::string inner = text_of_columns(value, depth + 1); !inner.empty()) return above + inner;
  }
  if (columns.empty()) return {};
  std::string text = above;
  for (const auto& [name, values] : columns) {
    if (values->size() != columns[0].second->size()) return {};
    text += (&name == &columns[0].first ? "" : ",") + cell_of(name);
  }
  for (std::size_t row = 0; row < columns[0].second->size(); ++row) {
    text += '\n';
    for (const auto& [name, values] : columns)
      text += (&name == &columns[0].first ? "" : ",") + cell_of((*values)[row]);
  }
  return text + '\n';
}

/// Where one of these words begins outside quoted text, from the first to the last, with the word.
std::vector<std::pair<std::size_t, std::string_view>> words_outside_quotes(
    std::string_view content, const std::vector<std::string_view>& words) {
  std::vector<std::pair<std::size_t, std::string_view>> found;
  bool quoted = false;
  for (std::size_t i = 0; i < content.size(); ++i) {
    if (content[i] == '"' && (i == 0 || content[i - 1] != '\\')) quoted = !quoted;
    const auto word = std::ranges::find_if(words, [&](auto w) { return content.substr(i).starts_with(w); });
    if (quoted || word == words.end()) continue;
    found.emplace_back(i, *word);
    i += word->size() - 1;
  }
  return found;
}

/// NaN and infinities, which Python writes though JSON has none, as null: what was not read.
std::string with_nulls(const std::string& content) {
  std::string text;
  std::size_t written = 0;
  for (const auto& [at, word] : words_outside_quotes(content, {"NaN", "-Infinity", "Infinity"})) {
    text.append(content, written, at - written).append("null");
    written = at + word.size();
  }
  return text.append(content, written);
}

/// Where a number beyond doubles stands, which the library names and does not place: "parsing '1e999'".
std::size_t place_of_number(std::string_view content, std::string_view message) {
  const std::size_t from = message.find('\'') + 1, to = message.rfind('\'');
  if (from == 0 || to <= from) return 0;
  const auto places = words_outside_quotes(content, {message.substr(from, to - from)});
  return places.empty() ? 0 : places.front().first;
}

/// @param first line of the file. @throws InputError at the first letter that no document of JSON has there
Json document_of(const std::string& file, const std::string& content, std::size_t first = 1) {
  try {
    return Json::parse(content);
  } catch (const Json::exception& error) {
    const auto* const parsing = dynamic_cast<const Json::parse_error*>(&error);
    const std::size_t at =
        !parsing ? place_of_number(content, error.what()) : std::max<std::size_t>(parsing->byte, 1) - 1;
    const std::string_view before = std::string_view(content).substr(0, at);
    const std::size_t line = static_cast<std::size_t>(std::ranges::count(before, '\n')) + first,
                      column = before.size() - (before.rfind('\n') + 1) + 1;
    throw InputError({file, line, column},
                     parsing ? "JSON is broken here; expected an array of objects or of rows"
                             : "a number beyond double precision; expected one below 1.8e308");
  }
}

/// An object in each line; others are cut, or words of a console.
/// @throws InputError where a number of one is beyond double precision, or where there are none
Json objects_of_lines(const std::string& file, const std::string& content) {
  Json rows = Json::array();
  std::size_t number = 0;
  for (const std::string_view line : lines_of(content)) {
    ++number;
    const std::string text = with_nulls(std::string(line));
    try {
      if (Json row = Json::parse(text); row.is_object()) rows.push_back(std::move(row));
    } catch (const Json::parse_error&) {
    } catch (const Json::out_of_range&) {
      document_of(file, text, number);
    }
  }
  return rows.empty() ? document_of(file, with_nulls(content)) : rows;
}

/// Columns of pandas, objects with one number for each row ({"t": {"0": 0.01, "1": 0.02}}), as arrays.
void turn_columns_to_arrays(Json& object) {
  constexpr std::size_t fewest = 16;
  for (auto& [name, value] : object.items())
    if (value.is_object() && value.size() >= fewest && value.contains("0") && value.contains("1") &&
        std::ranges::none_of(value, [](const Json& one) { return one.is_structured(); })) {
      Json numbers = Json::array();
      for (Json& one : value) numbers.push_back(std::move(one));
      value = std::move(numbers);
    }
}

/// Its rows or columns as a text with separators; a document, or a line for each row.
/// @throws InputError where it is neither
std::string text_of_json(const std::string& file, const std::string& content) {
  constexpr std::size_t longest = 200'000'000;
  Json json(Json::value_t::discarded);
  if (content.size() < longest) {
    json = Json::parse(content, nullptr, false);
    if (json.is_discarded()) {
      const std::string text = with_nulls(content);
      const bool is_document = text.find_first_not_of(" \t\r\n") == text.find('[');
      json = is_document ? document_of(file, text) : Json::parse(text, nullptr, false);
    }
  }
  if (json.is_discarded()) json = objects_of_lines(file, content);
  if (json.is_object()) turn_columns_to_arrays(json);
  const std::string text = json.is_object() ? text_of_columns(json) : text_of_rows(json);
  if (text.empty())
    throw InputError(
        {file, 0, 0},
        "JSON without rows or columns of numbers; expected an array of objects, such as "
        "[{\"t\": 0, \"acc\": 0.25}], or arrays of equal length: write them as columns of a CSV file");
  return text;
}

class DelimitedTextReader final : public RecordReader {
 public:
  /// Whatever no other reader knows is taken for text, and refused in its words.
  bool recognises(std::string_view) const override { return false; }

  RecordTable read(const std::filesystem::path& file, const RecordFormat& format) const override {
    refuse_other_kinds(file);
    std::string text = read_text(file, "a record of numbers in columns");
    if (!begins_as_json(text)) return table_of_text(file.string(), std::move(text), format);
    RecordTable table = table_of_text(file.string(), text_of_json(file.string(), text), format);
    table.remarks.emplace_back("Read from JSON: its names are those of the columns.");
    return table;
  }
};

const bool delimited_text_registered = record_reader_registry().add(
    {"delimited_text",
     "rows of numbers in columns parted by tabs, semicolons, commas or blanks",
     "",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<DelimitedTextReader>(); }});

/// Whole seconds, and in the next column, named for a unit, the rest of them: 17:02:05, 001000 us.
void add_rest_of_seconds(RecordTable& table) {
  if (!table.time || *table.time + 1 >= table.width() || table.names.size() != table.width()) return;
  const std::size_t next = *table.time + 1;
  const auto unit = table.names[next] == "min" ? std::nullopt : seconds_per_unit(table.names[next]);
  const std::vector<double>&seconds = table.columns[*table.time], &rest = table.columns[next];
  if (!unit || !(*unit < 1.0) || rises(seconds) || rises(rest)) return;
  std::vector<double> sum(table.rows());
  for (std::size_t row = 0; row < sum.size(); ++row) {
    const double part = rest[row] * *unit;
    if (!(part >= 0.0 && part < 1.0) || seconds[row] != std::floor(seconds[row])) return;
    sum[row] = seconds[row] + part;
  }
  if (!rises(sum)) return;
  table.names[next] = "rest of the seconds";
  if (next < table.units.size()) table.units[next].clear();
  table.columns[*table.time] = std::move(sum);
  table.precision[*table.time].add(
      fmt::format("0.{:0{}}", 0, static_cast<int>(std::lround(-std::log10(*unit)))));
  table.remarks.push_back(
      fmt::format("Column {} holds the rest of the seconds in column {}.", next + 1, next));
}

/// At most so many characters, without a line that would be cut.
std::size_t as_whole_lines(std::string_view text, std::size_t most) {
  if (text.size() <= most) return text.size();
  const std::size_t end = text.find_last_of("\r\n", most);
  return end == text.npos ? 0 : end;
}

/// Dates and times of one column as seconds.
class StampColumn {
 public:
  /// @param before what the rows above come to. Dates are 0 [s], to which a column of times of day is added;
  /// past midnight these go on. Instants count from the whole second of the first, as a double holds the rest
  /// finely then.
  double seconds_of(const Stamp& stamp, const std::vector<double>& before) {
    constexpr double half_a_day = 43200.0;
    if (stamp.parts >= 0) {
      parts_.resize(before.size(), 0);
      parts_.push_back(stamp.parts);
      padded_ = padded_ && stamp.decimals >= 3;
    }
    if (stamp.kind == Stamp::Kind::date) {
      day_ = before.empty() || stamp.seconds > day_ ? stamp.seconds : std::nan("");
      return 0.0;
    }
    if (stamp.kind == Stamp::Kind::date_and_time) {
      if (!first_) first_ = std::floor(stamp.seconds);
      return stamp.seconds - *first_;
    }
    const double value = stamp.seconds + days_;
    if (before.empty() || !(value < before.back() - half_a_day)) return value;
    days_ += 2.0 * half_a_day;
    return value + 2.0 * half_a_day;
  }

  bool holds_dates() const { return std::isfinite(day_); }  ///< each later than the one before
  bool holds_parts() const { return !parts_.empty() && !padded_; }

  /// Parts of seconds behind a colon that are no decimals. @returns false: nothing shows how many make a
  /// second
  bool bring_parts_to(std::vector<double>& column) const {
    if (parts_.size() != column.size()) return false;
    std::vector<double> whole(column.size());
    for (std::size_t row = 0; row < whole.size(); ++row) whole[row] = std::floor(column[row] + 1e-6);
    const auto count = parts_of_second(whole, parts_, padded_);
    for (std::size_t row = 0; count && row < whole.size(); ++row)
      column[row] = whole[row] + parts_[row] / *count;
    return count.has_value();
  }

 private:
  std::optional<double> first_;  ///< [s]
  double days_ = 0.0;            ///< that have passed [s]
  double day_ = std::nan("");    ///< the last date [s]
  std::vector<int> parts_;       ///< of seconds, behind a colon
  bool padded_ = true;           ///< to three digits at least
};

}  // namespace

RecordTable table_of_text(const std::string& file, std::string as_read, const RecordFormat& format) {
  constexpr std::size_t looked_at_for_a_rate = 4000, looked_at_for_a_unit = 20000, looked_at_behind = 500;
  bring_to_utf8(as_read);
  const bool turned = format.header_lines == 0 && turn_lines_to_columns(as_read);
  const std::string beginning = as_read.substr(0, looked_at_for_a_unit),
                    end = as_read.substr(as_read.size() - std::min(as_read.size(), looked_at_behind));
  const auto content = std::make_shared<std::string>(std::move(as_read));
  const std::optional<SensorRows> sensors = bring_to_fields(file, format, *content);
  DelimitedText text(file, *content, format.separator, format.header_lines, format.decimal,
                     format.malformed == MalformedRows::skip);
  RecordTable table;
  table.file = file;
  table.names = text.names();
  constexpr std::size_t longest_name = 400;
  for (std::string& name : table.names) name.resize(std::min(name.size(), longest_name));
  table.by_people = true;
  table.units = text.units();
  table.header_line = text.header_line();
  table.columns.resize(text.width());
  table.precision.resize(text.width());
  for (std::vector<double>& column : table.columns)
    column.reserve(static_cast<std::size_t>(std::ranges::count(*content, '\n')) + 1);
  TextCells cells(table.file, content);
  std::vector<StampColumn> stamps(text.width());
  std::size_t above = 0;  // characters before the first row
  while (text.next()) {
    if (table.lines.empty()) above = static_cast<std::size_t>(text.line().data() - content->data());
    cells.add(text.line(), text.line_number());
    for (std::size_t column = 0; column < text.width(); ++column) {
      std::string token(text.field(column));
      double value = text.value(column);
      const auto stamp = std::isfinite(value) ? std::nullopt : parse_stamp(unquoted(token));
      if (stamp) {
        value = stamps[column].seconds_of(*stamp, table.columns[column]);
        token = printed_like(*stamp);
        if (!table.time && table.lines.empty() && stamp->kind != Stamp::Kind::date) table.time = column;
      } else if (text.decimal() == ',') {
        std::ranges::replace(token, ',', '.');
      }
      if (std::isfinite(value) && !(stamp && stamp->kind == Stamp::Kind::date))
        table.precision[column].add(token);
      table.columns[column].push_back(value);
    }
    table.lines.add(text.line_number());
    text.take_plain_rows(table, cells);
  }
  for (std::size_t column = 0; !table.time && column < text.width(); ++column)
    if (stamps[column].holds_dates() && table.rows() > 1 && !format.sampling_rate)
      throw InputError({table.file, table.lines[0], 0},
                       fmt::format("column {} holds dates without times of day; expected times, or the "
                                   "sampling rate: --rate HZ",
                                   column + 1));
  for (std::size_t column = 0; column < text.width(); ++column)
    if (stamps[column].holds_parts() && !stamps[column].bring_parts_to(table.columns[column])) {
      if (!format.sampling_rate)
        throw InputError(table.place(0, column),
                         "parts of seconds behind a colon, hundredths or frames; expected a point before "
                         "decimals, or the sampling rate: --rate HZ");
      std::ranges::fill(table.columns[column], std::nan(""));
      table.time.reset();
    }
  table.cell = cells.cells(text.separator());
  const std::string_view head = std::string_view(beginning).substr(0, above);
  const std::size_t cut = as_whole_lines(beginning, looked_at_for_a_rate);
  table.stated_rate = stated_rate(beginning.substr(0, cut), text.decimal());
  if (!table.stated_rate && !text.skipped_lines().empty() && end.size() < beginning.size())
    table.stated_rate = stated_rate(end.substr(std::min(end.find('\n'), end.size())), text.decimal());
  take_stated_unit(table, head, !format.channels.empty());
  table.skipped_lines = text.skipped_lines();
  take_start_and_rate(table);
  add_rest_of_seconds(table);
  bring_in_order(table);
  part_sensors(table, sensors);
  if (turned) table.remarks.emplace_back("Each line of the file is a channel.");
  if (format.channels.empty()) join_rows_that_go_on(table, head, text.short_end());
  if (text.decimal() == ',') table.remarks.emplace_back("Its numbers have a decimal comma.");
  return table;
}

}  // namespace beamid::experiments
