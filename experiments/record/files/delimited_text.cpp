// Rows of numbers in columns: the text export of nearly every analyser.
#include "experiments/record/delimited_text.hpp"

#include <fmt/format.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <regex>
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
  const std::size_t inside = std::min(text.find_first_not_of(" \t\r\n", 1), text.size());
  const bool object = text.starts_with("{") && (text.substr(inside).starts_with("\"") ||
                                                text.substr(inside).starts_with("}"));  // not "{System 1};"
  if (object || text.starts_with("[{") || text.starts_with("[["))
    refuse("JSON", "write its arrays as columns of a CSV file");
}

class DelimitedTextReader final : public RecordReader {
 public:
  /// Whatever no other reader knows is taken for text, and refused in its words.
  bool recognises(std::string_view) const override { return false; }

  RecordTable read(const std::filesystem::path& file, const RecordFormat& format) const override {
    refuse_other_kinds(file);
    return table_of_text(file.string(), read_text(file, "a record of numbers in columns"), format);
  }
};

const bool delimited_text_registered = record_reader_registry().add(
    {"delimited_text",
     "rows of numbers in columns parted by tabs, semicolons, commas or blanks",
     "",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<DelimitedTextReader>(); }});

// Text as people and programs write it, brought to fields and separators. Only the digits behind a label and
// what follows a typographic minus move, so that messages name the places of the file.

using Fields = std::vector<std::string_view>;

/// Whether every one of several lines across the text fulfils it: what holds for its rows, whatever is above.
bool holds_across(std::string_view text, const std::function<bool(std::string_view)>& fulfilled) {
  constexpr double places[] = {0.3, 0.45, 0.6, 0.75, 0.9};
  return std::ranges::all_of(places, [&](double place) {
    const std::string_view line = line_near(text, place);
    return !line.empty() && fulfilled(line);
  });
}

/// A number, a stamp, or "x: 0.25".
bool is_value(std::string_view field) {
  return is_reading(field) || label_length(field) > 0;
}

/// Calls for each line, which may be changed in place.
void change_lines(std::string& text, const std::function<void(char* line, std::size_t length)>& change) {
  for (std::size_t line = 0; line < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", line), text.size());
    if (end > line) change(text.data() + line, end - line);
    line = end + 1;
  }
}

/// A minus of typography before a number, as one of ASCII.
void write_minus(std::string& text) {
  constexpr std::string_view minus = "\xE2\x88\x92";
  std::size_t to = text.find(minus);
  for (std::size_t at = to; at < text.size();) {
    const bool found = text.compare(at, minus.size(), minus) == 0;
    text[to++] = found ? '-' : text[at];
    at += found ? minus.size() : 1;
  }
  if (to != text.npos) text.resize(to);
}

/// Where the stamp in front of a row ends, and where the row goes on.
struct StampInFront {
  std::size_t end = 0, rest = 0;  ///< 0: there is none
};

/// Of "10:00:00.000 -> 7.51,3.0" and "10:00:00.000 > " of serial monitors, "[2026-11-26
/// 10:00:00.000] 7.51 3.0" of terminals, and "2026-11-26 10:00:00.000 7.51,3.0": a stamp that no separator
/// parts from the row.
StampInFront stamp_in_front(std::string_view line) {
  const bool bracket = line.starts_with('[');
  const std::size_t begin = bracket ? 1 : 0;
  std::size_t end = line.find(' ', begin);
  if (begin >= line.size() || line[begin] < '0' || line[begin] > '9') return {};
  const auto stamp_to = [&](std::size_t to) {
    const std::size_t length = std::min(to, line.size()) - begin;
    return parse_stamp(line.substr(begin, length - (bracket && length > 0 ? 1 : 0)));
  };
  std::optional<Stamp> stamp = stamp_to(end + (bracket && end != line.npos && line[end - 1] != ']' ? 1 : 0));
  if (stamp && stamp->kind == Stamp::Kind::date && end != line.npos) {
    end = line.find(' ', end + 1);
    stamp = stamp_to(end);
  }
  const std::string_view whole = line.substr(0, end);
  if (whole.find_first_of(",;\t|") != whole.npos) return {};
  if (!stamp || stamp->kind == Stamp::Kind::date || (bracket && line[std::min(end, line.size()) - 1] != ']'))
    return {};
  if (end == line.npos) return {line.size(), line.size()};
  for (const std::string_view arrow : {" -> ", " > "})
    if (line.substr(end).starts_with(arrow)) return {end, end + arrow.size()};
  const std::string_view rest = line.substr(end + 1);  // "4,0001" is one number
  const char separator = separator_of(rest);
  const bool parted = separator != ' ' && !parse_number(trimmed(rest), ',').number &&
                      !parse_stamp(trimmed(line.substr(0, line.find(separator))));  // "10:00:00 PM,0.25"
  return bracket || parted ? StampInFront{end, end + 1} : StampInFront{};
}

/// What follows such stamps becomes a separator; stamps in front of no numbers become blanks.
void part_stamps(std::string& text) {
  char separator = ' ';
  if (!holds_across(text, [&](std::string_view line) {
        const StampInFront stamp = stamp_in_front(line);
        separator = separator_of(line.substr(stamp.rest));
        return stamp.rest > 0;
      }))
    return;
  change_lines(text, [&](char* line, std::size_t length) {
    const std::string_view whole(line, length);
    const StampInFront stamp = stamp_in_front(whole);
    if (stamp.rest == 0) return;
    const std::string_view rest = whole.substr(stamp.rest);
    Fields fields;
    split_fields(rest, separator, fields);
    const bool numbers = std::ranges::any_of(fields, is_value);
    const bool bracket = line[0] == '[', words = !trimmed(rest).empty();
    if (!numbers) std::fill_n(line, stamp.end, ' ');
    if (bracket) line[0] = line[stamp.end - 1] = ' ';
    std::fill(line + stamp.end, line + stamp.rest, ' ');
    if (words) line[stamp.end] = separator;
  });
}

/// A word in a row: no number, none with a unit behind it, and no time; but a number in hexadecimal digits.
bool is_word(std::string_view field) {
  if (field.empty() || says_missing(field) || parse_stamp(field)) return false;
  if (field.starts_with("0x") || field.starts_with("0X")) return true;
  constexpr std::string_view digits = "0123456789", signs = "+-.,";
  const bool of_number = digits.find(field.front()) != digits.npos || signs.find(field.front()) != signs.npos;
  const std::size_t colon = field.find(':');
  const bool of_time = colon != field.npos && colon > 0 && colon + 1 < field.size() &&
                       digits.find(field[colon - 1]) != digits.npos &&
                       digits.find(field[colon + 1]) != digits.npos;
  return !of_number && !of_time && label_length(field) == 0;
}

/// "X: 0.25  Y: 1.5": a label takes the number behind it, "X:0.25".
void join_labels(std::string& text) {
  const auto labelled = [](std::string_view line) {
    Fields fields;
    split_fields(line, ' ', fields);
    return fields.size() > 1 && (fields[0].ends_with(':') || fields[0].ends_with('=')) &&
           label_length(std::string(fields[0]) + std::string(fields[1])) > 0;
  };
  if (separator_of(text.substr(text.size() / 2, 400)) != ' ' || !holds_across(text, labelled)) return;
  change_lines(text, [&](char* line, std::size_t length) {
    if (!labelled({line, length})) return;
    for (std::size_t at = 0; at + 1 < length; ++at)
      if ((line[at] == ':' || line[at] == '=') && line[at + 1] == ' ') {
        const std::size_t from = std::string_view(line, length).find_first_not_of(' ', at + 1);
        if (from == std::string_view::npos) return;
        const std::size_t to = std::min(std::string_view(line, length).find(' ', from), length);
        std::rotate(line + at + 1, line + from, line + to);
        at += to - from;
      }
  });
}

/// Words in every row beside its numbers, as names of nodes, addresses and states, become cells that hold
/// nothing, or, between blanks, blanks.
void blank_words(std::string& text, char given) {
  char separator = given;
  std::vector<bool> words;
  if (!holds_across(text, [&](std::string_view line) {
        Fields fields;
        if (separator == '\0') separator = separator_of(line);
        split_fields(line, separator, fields);
        if (words.empty()) words.assign(fields.size(), true);
        if (fields.size() != words.size()) return false;
        for (std::size_t k = 0; k < words.size(); ++k) words[k] = words[k] && is_word(fields[k]);
        return std::ranges::any_of(fields, is_value);
      }))
    return;
  if (std::ranges::find(words, true) == words.end()) return;
  change_lines(text, [&](char* line, std::size_t length) {
    Fields fields;
    split_fields({line, length}, separator, fields);
    if (fields.size() != words.size() || std::ranges::none_of(fields, is_value)) return;
    for (std::size_t k = 0; k < words.size(); ++k) {
      if (!words[k] || !is_word(fields[k])) continue;
      char* const word = line + (fields[k].data() - line);
      std::fill_n(word, fields[k].size(), ' ');
      if (separator != ' ') *word = '-';
    }
  });
}

/// Of rows that name their sensor, as loggers of telephones write them, those of accelerations: others become
/// blanks. @throws InputError where there are several sensors and none of these
void keep_one_sensor(const std::string& file, std::string& text) {
  static const std::regex sensor(
      R"((?:lin\w*[_ ]?)?acc\w*|la|gyr\w*|mag\w*|gra?v\w*|rot\w*|prx|prox\w*|light|lux|pres\w*|baro\w*|ori\w*|temp\w*|gps|hr)",
      std::regex::icase),
      wanted(R"(acc\w*)", std::regex::icase);
  constexpr std::size_t first_cells = 3, fewest = 3;
  const char separator = separator_of(line_near(text, 0.5));
  for (std::size_t k = 0; k < first_cells; ++k) {
    const auto tag_of = [&](std::string_view line, Fields& fields) {
      split_fields(line, separator, fields);
      return k < fields.size() && fields.size() > k + 1 ? unquoted(fields[k]) : std::string();
    };
    if (!holds_across(text, [&](std::string_view line) {
          Fields fields;
          return std::regex_match(tag_of(line, fields), sensor);
        }))
      continue;
    std::map<std::string, std::size_t> rows;
    bool others = false;
    change_lines(text, [&](char* line, std::size_t length) {
      Fields fields;
      const std::string tag = tag_of({line, length}, fields);
      const bool row = std::ranges::any_of(fields, is_value);
      if (row && std::regex_match(tag, sensor))
        ++rows[tag];
      else
        others = others || row;
    });
    if (others || rows.size() < 2) continue;
    std::string list;
    for (const auto& [tag, count] : rows) list += (list.empty() ? "'" : ", '") + tag + "'";
    const auto kept = std::ranges::find_if(
        rows, [&](const auto& one) { return one.second > fewest && std::regex_match(one.first, wanted); });
    if (kept == rows.end())
      throw InputError({file, 0, 0}, "rows of several sensors, " + list +
                                         ", none of them accelerations; expected a file of one sensor");
    change_lines(text, [&](char* line, std::size_t length) {
      Fields fields;
      if (tag_of({line, length}, fields) != kept->first) std::fill_n(line, length, ' ');
    });
    return;
  }
}

/// Rows of a table as columns (width x rows): its numbers in the order of the text.
Eigen::MatrixXd series_of(const RecordTable& table) {
  Eigen::MatrixXd series(static_cast<Eigen::Index>(table.width()), static_cast<Eigen::Index>(table.rows()));
  for (std::size_t k = 0; k < table.width(); ++k)
    series.row(static_cast<Eigen::Index>(k)) =
        Eigen::Map<const Eigen::RowVectorXd>(table.columns[k].data(), series.cols());
  return series;
}

/// Rows without names or times that go on from one to the next: one series, written several numbers to a
/// line. The text above them states how many points there are, or the step from a row's last number to the
/// next row's first is that within the rows, and smaller than that down a column. Columns of a series are of
/// one mean and one size.
bool go_on(const RecordTable& table, std::string_view above, std::size_t last) {
  constexpr std::size_t fewest_columns = 3, fewest_rows = 20;
  constexpr double alike = 0.25, less = 0.6, one_mean = 0.25, one_size = 0.2, smooth = 0.9;
  if (!table.names.empty() || table.time || table.width() < fewest_columns || table.rows() < fewest_rows)
    return false;
  if (std::ranges::any_of(table.columns, rises)) return false;
  const Eigen::MatrixXd series = series_of(table);
  if (!series.allFinite()) return false;
  static const std::regex of_all("channel|kan(a|\xc3\xa4)l|canal|total", std::regex::icase);
  const std::string numbers = std::to_string(table.rows() * table.width() + last);
  const std::regex count("(^|[^0-9.])" + numbers + "($|[^0-9.])"),
      points("(points?|npts)[^0-9\n]{1,8}" + numbers + "($|[^0-9.])|(^|[^0-9.])" + numbers + " +points",
             std::regex::icase);
  const auto states = [&](const std::regex& one) {
    return std::regex_search(above.begin(), above.end(), one) &&
           !std::regex_search(above.begin(), above.end(), of_all);
  };
  if (states(points)) return true;
  const Eigen::Index width = series.rows(), rows = series.cols();
  const double mean = series.mean(), size = std::sqrt((series.array() - mean).square().mean());
  const Eigen::VectorXd means = series.rowwise().mean(),
                        sizes = (series.colwise() - means).cwiseAbs2().rowwise().mean().cwiseSqrt();
  if (!((means.array() - mean).abs() <= one_mean * size).all() ||
      !((sizes.array() - size).abs() <= one_size * size).all())
    return false;
  const double within = (series.bottomRows(width - 1) - series.topRows(width - 1)).cwiseAbs().mean(),
               down = (series.rightCols(rows - 1) - series.leftCols(rows - 1)).cwiseAbs().mean(),
               over = (series.row(0).tail(rows - 1) - series.row(width - 1).head(rows - 1)).cwiseAbs().mean();
  if (!(within > 0.0) || std::abs(over / within - 1.0) > alike || within > smooth * size) return false;
  return within < less * down || states(count);
}

void join_rows(RecordTable& table, const std::vector<double>& last) {
  const Eigen::MatrixXd series = series_of(table);
  std::vector<double> all(series.data(), series.data() + series.size());
  all.insert(all.end(), last.begin(), last.end());
  table.remarks.push_back(
      fmt::format("Each row of {} numbers goes on from the row before: one series of {} numbers.",
                  table.width(), all.size()));
  table.columns.assign(1, std::move(all));
  table.precision.resize(1);
  table.lines.clear(), table.skipped_lines.clear();
  table.cell = nullptr;
}

}  // namespace

RecordTable table_of_text(const std::string& file, std::string as_read, const RecordFormat& format) {
  constexpr std::size_t looked_at_for_a_rate = 4000, looked_at_for_a_unit = 20000;
  const std::string beginning = as_read.substr(0, looked_at_for_a_unit);
  const auto content = std::make_shared<std::string>(std::move(as_read));
  write_minus(*content);
  part_stamps(*content);
  join_labels(*content);
  if (format.header_lines == 0) {
    keep_one_sensor(file, *content);
    blank_words(*content, format.separator);
  }
  DelimitedText text(file, *content, format.separator, format.header_lines, format.decimal,
                     format.malformed == MalformedRows::skip);
  RecordTable table;
  table.file = file;
  table.names = text.names();
  table.by_people = true;
  table.units = text.units();
  table.header_line = text.header_line();
  table.columns.resize(text.width());
  table.precision.resize(text.width());
  TextCells cells(table.file, content);
  std::string token;
  std::vector<std::optional<double>> first_stamp(
      text.width());  // whole seconds: a double holds the rest finely
  constexpr double half_a_day = 43200.0;
  std::vector<double> days(text.width(), 0.0);          // that have passed [s]
  std::vector<double> day(text.width(), std::nan(""));  // of dates, each later than the one before [s]
  std::size_t above = 0;                                // characters before the first row
  while (text.next()) {
    if (table.lines.empty()) above = static_cast<std::size_t>(text.line().data() - content->data());
    cells.add(text.line(), text.line_number());
    table.lines.push_back(text.line_number());
    for (std::size_t column = 0; column < text.width(); ++column) {
      table.columns[column].push_back(text.value(column));
      token = text.field(column);
      if (!std::isfinite(table.columns[column].back())) {
        const std::string field = unquoted(token);
        double& value = table.columns[column].back();
        if (const auto stamp = parse_stamp(field)) {
          if (stamp->kind == Stamp::Kind::date) {
            value = 0.0;
            day[column] =
                table.lines.size() == 1 || stamp->seconds > day[column] ? stamp->seconds : std::nan("");
          } else if (stamp->kind == Stamp::Kind::time_of_day) {  // past midnight the days go on
            value = stamp->seconds + days[column];
            const std::size_t rows = table.columns[column].size();
            if (rows > 1 && value < table.columns[column][rows - 2] - half_a_day)
              value += 2.0 * half_a_day, days[column] += 2.0 * half_a_day;
          } else {
            if (!first_stamp[column]) first_stamp[column] = std::floor(stamp->seconds);
            value = stamp->seconds - *first_stamp[column];
          }
          if (!table.time && table.lines.size() == 1 && stamp->kind != Stamp::Kind::date) table.time = column;
          token = printed_like(*stamp);
          if (stamp->kind != Stamp::Kind::date) table.precision[column].add(token);
          continue;
        }
      }
      if (text.decimal() == ',')
        for (char& sign : token) sign = sign == ',' ? '.' : sign;
      if (std::isfinite(table.columns[column].back())) table.precision[column].add(token);
    }
  }
  for (std::size_t column = 0; !table.time && column < text.width(); ++column)
    if (std::isfinite(day[column]) && table.rows() > 1 && !format.sampling_rate)
      throw InputError({table.file, table.lines.front(), 0},
                       fmt::format("column {} holds dates without times of day; expected times, or the "
                                   "sampling rate: --rate HZ",
                                   column + 1));
  table.cell = cells.cells(text.separator());
  const std::string_view head = std::string_view(beginning).substr(0, above);
  table.stated_rate = stated_rate(beginning.substr(0, looked_at_for_a_rate), text.decimal());
  take_stated_unit(table, head, !format.channels.empty());
  table.skipped_lines = text.skipped_lines();
  if (format.channels.empty() && go_on(table, head, text.short_end().size()))
    join_rows(table, text.short_end());
  if (text.decimal() == ',') table.remarks.emplace_back("Its numbers have a decimal comma.");
  return table;
}

}  // namespace beamid::experiments
