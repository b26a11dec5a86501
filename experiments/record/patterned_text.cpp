// Text in which every row has the same words and signs around its numbers, as programs print them for
// people: "Acceleration X: 0.25, Y: 1.5 m/s^2", "2026-11-26 10:00:00,125 INFO 0.25", "(0.01, 0.25)"; and rows
// of several sensors, one behind the other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "experiments/record/delimited_text.hpp"
#include "experiments/record/recognised_column.hpp"
#include "experiments/record/stamps.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {
namespace {

using Fields = std::vector<std::string_view>;

bool is_digit(char letter) {
  return letter >= '0' && letter <= '9';
}
bool is_letter(char letter) {
  return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') || (letter & 0x80) != 0;
}
bool is_of_word(char letter) {
  return is_letter(letter) || is_digit(letter) || letter == '_';
}

/// Lines across a text, from where its rows are.
std::vector<std::string_view> lines_across(std::string_view text) {
  constexpr int count = 24;
  std::vector<std::string_view> lines;
  for (int k = 0; k < count; ++k)
    if (const auto line = line_near(text, 0.3 + 0.65 * k / count); lines.empty() || line != lines.back())
      lines.push_back(line);
  return lines;
}

/// Length of the stamp that begins a text; 0: none does.
std::size_t stamp_length(std::string_view text) {
  constexpr std::string_view signs = "0123456789:.,T+-/Z ";
  constexpr std::size_t shortest = 8, longest = 40;
  std::string_view stamp = text.substr(0, std::min(text.find_first_not_of(signs), longest));
  while (stamp.size() >= shortest) {
    while (!stamp.empty() && !is_digit(stamp.back()) && stamp.back() != 'Z') stamp.remove_suffix(1);
    const auto found = parse_stamp(stamp);
    if (found && found->kind != Stamp::Kind::date) return stamp.size();
    const std::size_t cut = stamp.find_last_of(" ,+-");
    stamp = stamp.substr(0, cut == stamp.npos ? 0 : cut);
  }
  return 0;
}

/// Length of the number that begins a text; 0: none does. Of a unit, no other letters, behind it.
std::size_t number_length(std::string_view text) {
  std::size_t at = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
  const auto pass_digits = [&] {
    const std::size_t from = at;
    while (at < text.size() && is_digit(text[at])) ++at;
    return at - from;
  };
  std::size_t digits = pass_digits();
  if (at < text.size() && text[at] == '.') ++at, digits += pass_digits();
  if (digits == 0) return 0;
  if (at + 1 < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    const std::size_t before = at++;
    if (text[at] == '-' || text[at] == '+') ++at;
    if (pass_digits() == 0) at = before;
  }
  std::size_t end = at;
  while (end < text.size() && is_of_word(text[end])) ++end;
  if (end > at && !are_units({text.substr(at, end - at)})) return 0;
  return at < text.size() && text[at] == '.' ? 0 : at;
}

/// A line as numbers, stamps among them, and what stands in front of each and behind the last.
struct PatternedLine {
  Fields numbers;
  std::vector<std::string> texts;  ///< of single blanks, one more than numbers

  explicit PatternedLine(std::string_view line) {
    constexpr std::string_view hexadecimal = "0123456789ABCDEFabcdef";
    line = trimmed(line);
    if (line.size() > 3 && line[line.size() - 3] == '*' &&
        line.find_last_not_of(hexadecimal) == line.size() - 3)
      line.remove_suffix(3);  // the sum of a sentence, "*3C"
    std::string text;
    for (std::size_t at = 0; at < line.size();) {
      std::size_t length = stamp_length(line.substr(at));
      if (length == 0) length = number_length(line.substr(at));
      const char before = at > 0 ? line[at - 1] : ' ';
      const bool touches = is_digit(before) || before == '.' || before == '^' || before == '*';
      if (touches && line.substr(at, length).find('.') == line.npos)
        length = 0;  // "-0.5E+00-0.5", no "5-100"
      if (length > 0) {
        numbers.push_back(line.substr(at, length));
        texts.emplace_back(text == ", " ? std::string_view(text) : trimmed(text));
        text.clear();
        at += length;
        continue;
      }
      // The rest of a word, "0x50" and "192.168.1.1" too, is no number.
      const bool word = is_of_word(line[at]) || line[at] == '-' || line[at] == '+' || line[at] == '.';
      do {
        const bool blank = line[at] == ' ' || line[at] == '\t';
        if (!blank || !text.ends_with(' ')) text += blank ? ' ' : line[at];
        ++at;
      } while (word && at < line.size() && (is_of_word(line[at]) || line[at] == '.'));
    }
    texts.emplace_back(trimmed(text));
  }
};

/// The words of a text between numbers; "Acceleration X: " are two, "INFO" of a log is none.
std::vector<std::string> words_of_text(std::string_view text) {
  static const std::set<std::string> levels{"info", "debug", "warning", "warn", "error", "critical", "trace"};
  std::vector<std::string> words;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at;
    while (end < text.size() && is_of_word(text[end])) ++end;
    if (end > at && is_letter(text[at]))
      if (const std::string word(text.substr(at, end - at)); !levels.contains(folded(word)))
        words.push_back(word);
    at = std::max(end, at + 1);
  }
  return words;
}

/// The unit that begins a text behind a number, with the rest of the text; empty: there is none.
std::string_view unit_in_front(std::string_view text) {
  const std::string_view unit = text.substr(0, text.find_first_of(" ,;|:=)}\t"));
  const bool labels = unit.size() < text.size() && (text[unit.size()] == ':' || text[unit.size()] == '=');
  return !unit.empty() && !is_digit(unit[0]) && !labels && unit != "-" && are_units({unit})
             ? unit
             : std::string_view();
}

/// What all rows of a text have around their numbers, and the names that this gives the columns.
class Pattern {
 public:
  explicit Pattern(const std::vector<std::string_view>& lines) {
    constexpr std::size_t fewest_lines = 8;
    for (const std::string_view line : lines) rows_.emplace_back(line);
    if (rows_.size() < fewest_lines || rows_[0].numbers.size() < 1) return;
    is_one_ = std::ranges::all_of(rows_, [&](const PatternedLine& row) { return fits(row); });
    if (is_one_) name_numbers();
  }

  /// Whether it is one, and no comma without a blank is a decimal sign.
  bool is_certain() const {
    for (std::size_t k = 1; is_one_ && k < rows_[0].numbers.size(); ++k)
      if (rows_[0].texts[k] == "," && std::ranges::none_of(rows_, [&](const PatternedLine& row) {
            return row.numbers[k].find('.') != std::string_view::npos;
          }))
        return false;
    const auto has_letters = [](const std::string& text) { return std::ranges::any_of(text, is_letter); };
    const bool words = std::ranges::any_of(rows_[0].texts, has_letters);
    const bool touch = rows_[0].texts.size() > 2 && std::ranges::all_of(rows_[0].texts, &std::string::empty);
    return is_one_ && !(has_units() && names_.empty()) &&   // names above them have units of their own
           (words || touch || !rows_[0].texts[0].empty());  // no "0.25;6 / 12;10"
  }
  bool has_units() const {
    return std::ranges::any_of(units_, [](auto one) { return !one.empty(); });
  }
  bool fits(const PatternedLine& row) const { return row.texts == rows_[0].texts; }
  bool has_times() const {
    return std::ranges::any_of(rows_[0].numbers, [](auto one) { return parse_stamp(one).has_value(); }) ||
           std::ranges::any_of(names_, [](const std::string& name) {
             const auto found = recognise_column(name, "");
             return found && found->kind == RecognisedColumn::Kind::time;
           });
  }

  /// A row between tabs, its numbers labelled.
  std::string written(const PatternedLine& row) const {
    std::string line;
    for (std::size_t k = 0; k < row.numbers.size(); ++k) {
      if (stands_[k]) continue;
      line += line.empty() ? "" : "\t";
      if (!names_.empty() && !parse_stamp(row.numbers[k])) line += names_[k] + ":";
      line += row.numbers[k];
    }
    return line;
  }

 private:
  bool changes(std::size_t k) const {
    return std::ranges::any_of(rows_, [&](const auto& row) { return row.numbers[k] != rows_[0].numbers[k]; });
  }
  bool rises_from_row_to_row(std::size_t k) const {
    std::vector<double> values;
    for (const PatternedLine& row : rows_) values.push_back(parse_number(row.numbers[k]).value);
    return rises(values);
  }

  void name_numbers() {
    const std::size_t count = rows_[0].numbers.size();
    std::vector<std::string> texts = rows_[0].texts;
    units_.assign(count, "");
    stands_.assign(count, false);
    for (std::size_t k = 0; k < count; ++k)
      if (const std::string unit(unit_in_front(texts[k + 1])); !unit.empty())
        units_[k] = unit, texts[k + 1].erase(0, unit.size());
    if (std::ranges::all_of(texts, [](const auto& text) { return words_of_text(text).empty(); })) return;
    std::string group;
    for (std::size_t k = 0; k < count; ++k) names_.push_back(name_of(k, words_of_text(texts[k]), group));
    if (std::ranges::all_of(names_, [](const auto& name) { return name == "number" || name == "time"; })) {
      names_.clear();
      return;
    }
    const bool for_all = !units_.back().empty() && std::ranges::count(units_, "") + 1 == std::ssize(units_);
    for (std::size_t k = 0; k < count; ++k) {
      const auto found = recognise_column(names_[k], "");
      const bool signal = found && found->kind == RecognisedColumn::Kind::signal && !found->states_unit;
      const std::string& unit = for_all && signal ? units_.back() : units_[k];
      if (!unit.empty()) names_[k] += " [" + unit + "]";
    }
  }

  /// @param group what the words in front of the last axis say of those that follow, "Acceleration"
  std::string name_of(std::size_t k, std::vector<std::string> words, std::string& group) {
    const auto joined = [](const std::vector<std::string>& parts) {
      std::string text;
      for (const std::string& part : parts) text += (text.empty() ? "" : " ") + part;
      return text;
    };
    const auto is_axis = [](const std::string& word) {
      const std::string small = folded(word);
      return small == "x" || small == "y" || small == "z";
    };
    const bool whole = rows_[0].numbers[k].find('.') == std::string_view::npos;
    if (words.empty()) {
      stands_[k] = !changes(k) && whole;
      if (rises_from_row_to_row(k)) return "time";
      return group.empty() || k == 0 ? "number" : group;
    }
    const std::string last = words.back();
    const auto one = recognise_column(last, "");
    const bool says_itself = one && (one->states_quantity || one->kind != RecognisedColumn::Kind::signal);
    stands_[k] = !says_itself && !is_axis(last) && !changes(k) && whole;  // "imu[812]"
    if (stands_[k]) return "number";
    if (is_axis(last)) {
      words.pop_back();
      if (!words.empty()) group = joined(words);
      return group.empty() ? last : group + " " + last;
    }
    const bool component = last.size() > 1 && is_axis(last.substr(last.size() - 1));
    group = component ? "" : joined(words);
    return says_itself ? last : joined(words);
  }

  std::vector<PatternedLine> rows_;
  bool is_one_ = false;
  std::vector<std::string> names_, units_;
  std::vector<bool> stands_;  ///< numbers that are part of the words
};

/// Whether its numbers can be split from its words without the pattern, and no words beside labels say more.
bool splits_plainly(std::string_view line) {
  Fields fields;
  split_fields(line, separator_of(line), fields);
  const auto is_labelled = [](auto field) { return label_length(field) > 0 || parse_stamp(field); };
  const bool words = std::erase_if(fields, is_word) > 0;
  std::erase_if(fields, says_missing);
  if (fields.empty()) return false;
  return std::ranges::all_of(fields, is_reading) || (!words && std::ranges::all_of(fields, is_labelled));
}

}  // namespace

void bring_pattern_to_fields(std::string& text) {
  const std::vector<std::string_view> lines = lines_across(text);
  const Pattern pattern(lines);
  if (!pattern.is_certain()) return;
  const bool labelled = std::ranges::any_of(lines, [](auto line) {
    Fields fields;
    split_fields(line, separator_of(line), fields);
    return std::ranges::any_of(fields, label_length);
  });
  if (std::ranges::all_of(lines, splits_plainly) && !(pattern.has_units() && labelled)) return;
  std::string written;
  bool rows = false;
  for (std::size_t line = 0; line < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", line), text.size());
    const std::string_view whole = std::string_view(text).substr(line, end - line);
    const PatternedLine row(whole);
    const bool fits = !row.numbers.empty() && pattern.fits(row);
    rows = rows || fits;
    if (fits)
      written += pattern.written(row);
    else if (!rows || !(pattern.has_times() || end + 2 >= text.size()))
      written += whole;
    if (end < text.size()) written += text[end];
    line = end + 1;
  }
  text = std::move(written);
}

std::optional<SensorRows> number_sensors(std::string& text) {
  constexpr std::size_t first_cells = 4, most_sensors = 32, fewest_rows = 16;
  const std::vector<std::string_view> lines = lines_across(text);
  const char separator = separator_of(lines[lines.size() / 2]);
  Fields fields;
  split_fields(lines[lines.size() / 2], separator, fields);
  const std::size_t width = fields.size();
  for (std::size_t k = 0; k < std::min(first_cells, width); ++k) {
    const auto tag_of = [&](std::string_view line) {
      split_fields(line, separator, fields);
      const bool row = fields.size() == width && std::ranges::any_of(fields, [](auto field) {
                         return is_reading(field) || label_length(field) > 0;
                       });
      return row && is_word(fields[k]) ? fields[k] : std::string_view();
    };
    if (!std::ranges::all_of(lines, [&](auto line) { return !tag_of(line).empty(); })) continue;
    std::vector<std::string_view> tags;
    std::map<std::string_view, std::size_t> rows;
    for (std::string_view rest = text; !rest.empty() && rows.size() <= most_sensors;)
      if (const std::string_view tag = tag_of(take_line(rest)); !tag.empty() && rows[tag]++ == 0)
        tags.push_back(tag);
    const auto [fewest, most] =
        std::ranges::minmax_element(rows, {}, [](const auto& one) { return one.second; });
    if (tags.size() < 2 || tags.size() > most_sensors || fewest->second < fewest_rows ||
        most->second > fewest->second + fewest->second / 4)
      continue;
    SensorRows found{k, {}};
    std::map<std::string, std::string> numbers;
    for (const std::string_view tag : tags) {
      found.tags.emplace_back(unquoted(tag));
      numbers[std::string(tag)] = std::to_string(found.tags.size());
    }
    if (std::ranges::any_of(numbers, [](const auto& one) { return one.first.size() < one.second.size(); }))
      continue;
    for (std::size_t line = 0; line < text.size();) {
      const std::size_t end = std::min(text.find_first_of("\r\n", line), text.size());
      const std::string_view tag = tag_of(std::string_view(text).substr(line, end - line));
      if (const auto number = numbers.find(std::string(tag)); number != numbers.end() && !tag.empty()) {
        char* const at = text.data() + (tag.data() - text.data());
        std::fill_n(at, tag.size(), ' ');
        std::ranges::copy(number->second, at);
      }
      line = end + 1;
    }
    return found;
  }
  return {};
}

namespace {

/// Rows of each sensor, by the numbers of a column; empty: they are no sensors.
std::map<double, std::vector<std::size_t>> rows_of_sensors(const RecordTable& table, std::size_t column) {
  constexpr std::size_t most_sensors = 32, fewest_rows = 16;
  std::map<double, std::vector<std::size_t>> rows;
  for (std::size_t row = 0; row < table.rows() && rows.size() <= most_sensors; ++row)
    if (const double number = table.columns[column][row]; number == std::floor(number))
      rows[number].push_back(row);
    else
      return {};
  if (rows.size() < 2 || rows.size() > most_sensors) return {};
  for (const auto& [number, of_sensor] : rows)
    if (of_sensor.size() < fewest_rows) return {};
  return rows;
}

/// A column of numbers that its name says to be those of sensors.
std::optional<std::size_t> column_of_sensors(const RecordTable& table) {
  static const std::set<std::string> names{"sensor",   "sensors", "id",      "node",     "nodes",
                                           "channel",  "ch",      "axis",    "sensorid", "kanal",
                                           "knoten",   "canal",   "capteur", "nodo",     "nodeid",
                                           "sensornr", "achse",   "address", "addr",     "deviceid"};
  for (std::size_t column = 0; column < table.names.size() && column < table.width(); ++column) {
    std::string name = folded(table.names[column]);
    std::erase_if(name, [](char c) { return c == ' ' || c == '_' || c == '-' || c == '.'; });
    if (names.contains(name)) return column;
  }
  return {};
}

/// The column of times: that of stamps, else the first that rises for the first sensor and begins again, or
/// stands still, from one sensor to the other.
std::optional<std::size_t> times_of_sensors(const RecordTable& table, std::size_t sensors,
                                            const std::vector<std::size_t>& first) {
  if (table.time) return table.time;
  for (std::size_t column = 0; column < table.width(); ++column) {
    if (column == sensors) continue;
    std::vector<double> values;
    for (const std::size_t row : first) values.push_back(table.columns[column][row]);
    if (rises(values)) return column;
  }
  return {};
}

}  // namespace

void part_sensors(RecordTable& table, const std::optional<SensorRows>& tagged) {
  const std::optional<std::size_t> column = tagged ? std::optional(tagged->column) : column_of_sensors(table);
  if (!column || table.width() < 3) return;
  const auto rows = rows_of_sensors(table, *column);
  const auto drop = [&] {  // words that name no sensors are no motion
    if (tagged) std::ranges::fill(table.columns[*column], 0.0);
  };
  if (rows.empty()) return drop();
  const std::vector<std::size_t>& first = rows.begin()->second;
  const auto time = times_of_sensors(table, *column, first);
  std::size_t changes = 0, length = first.size();
  for (std::size_t row = 1; row < table.rows(); ++row)
    changes += table.columns[*column][row] != table.columns[*column][row - 1] ? 1 : 0;
  std::string list;
  const auto tag_of = [&](double number) {
    return tagged ? tagged->tags[static_cast<std::size_t>(number) - 1] : fmt::format("{}", number);
  };
  for (const auto& [number, of_sensor] : rows) {
    length = std::min(length, of_sensor.size());
    list += (list.empty() ? "'" : ", '") + tag_of(number) + "'";
  }
  if (!time || (2 * changes < table.rows() && rises(table.columns[*time]))) return drop();
  const std::vector<double>& times = table.columns[*time];
  for (const auto& [number, of_sensor] : rows)
    for (std::size_t k = 0; k < of_sensor.size(); ++k)
      if (of_sensor.size() > length + 1 || (k < length && times[of_sensor[k]] != times[first[k]]))
        throw InputError(table.row_place(of_sensor[k]),
                         fmt::format("rows of {} sensors, {}, each with times of its own; expected the same "
                                     "times for all, or a file for each sensor",
                                     rows.size(), list));
  RecordTable parted = table;
  parted.columns.clear(), parted.precision.clear(), parted.names.clear(), parted.units.clear();
  const auto add = [&](std::size_t from, const std::vector<std::size_t>& of_sensor, const std::string& tag) {
    std::vector<double>& values = parted.columns.emplace_back();
    for (std::size_t k = 0; k < length; ++k) values.push_back(table.columns[from][of_sensor[k]]);
    parted.precision.push_back(table.precision[from]);
    if (!table.names.empty()) parted.names.push_back(tag + table.names[from]);
    if (!table.units.empty()) parted.units.push_back(from < table.units.size() ? table.units[from] : "");
  };
  add(*time, first, "");
  for (const auto& [number, of_sensor] : rows)
    for (std::size_t from = 0; from < table.width(); ++from)
      if (from != *column && from != *time) add(from, of_sensor, tag_of(number) + " ");
  if (table.time) parted.time = 0;
  parted.lines.clear(), parted.cell = nullptr;
  parted.remarks.push_back(
      fmt::format("Rows of {} sensors, {}, of the same times: channels side by side.", rows.size(), list));
  table = std::move(parted);
}

}  // namespace beamid::experiments
