// Text as people and programs write it, brought to fields and separators. Only the digits behind a label and
// what follows a typographic minus move, so that messages name the places of the file.
#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "experiments/record/delimited_text.hpp"
#include "experiments/record/stamps.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {
bool holds_across(std::string_view text, const std::function<bool(std::string_view)>& fulfilled) {
  constexpr double places[] = {0.3, 0.45, 0.6, 0.75, 0.9};
  return std::ranges::all_of(places, [&](double place) {
    const std::string_view line = line_near(text, place);
    return !line.empty() && fulfilled(line);
  });
}

bool is_word(std::string_view field) {
  if (field.empty() || says_missing(field) || parse_stamp(field)) return false;
  if (field.starts_with("0x") || field.starts_with("0X")) return true;
  field.remove_prefix(std::min(field.find_first_not_of("([{"), field.size() - 1));  // "(0" is a number, cut
  constexpr std::string_view digits = "0123456789", signs = "+-.,";
  const bool of_number = digits.find(field.front()) != digits.npos || signs.find(field.front()) != signs.npos;
  const std::size_t colon = field.find(':');
  const bool of_time = colon != field.npos && colon > 0 && colon + 1 < field.size() &&
                       digits.find(field[colon - 1]) != digits.npos &&
                       digits.find(field[colon + 1]) != digits.npos;
  return !of_number && !of_time && label_length(field) == 0;
}

namespace {

using Fields = std::vector<std::string_view>;

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

/// "I (1000) imu: ax=0.25 ay=1.5" of a microcontroller's log becomes "ms=1000 ax=0.25 ay=1.5", and
/// "1000: 0.25, 1.5" becomes "1000, 0.25, 1.5".
void part_log_prefixes(std::string& text) {
  constexpr std::size_t number = 3;  // characters of "I ("
  const auto end_of_digits = [](std::string_view line, std::size_t from) {
    return std::min(line.find_first_not_of("0123456789", from), line.size());
  };
  const auto rest_of_log = [&](std::string_view line) -> std::size_t {  // 0: it is no line of such a log
    if (line.size() < number + 1 || std::string_view("EWIDV").find(line[0]) == line.npos ||
        line.substr(1, 2) != " (")
      return 0;
    const std::size_t end = end_of_digits(line, number), colon = line.find(": ", end);
    return end > number && line.substr(end).starts_with(") ") && colon != line.npos ? colon + 2 : 0;
  };
  const auto rest_of_count = [&](std::string_view line) -> std::size_t {
    const std::size_t end = end_of_digits(line, 0);
    return end > 0 && line.substr(end).starts_with(": ") ? end + 2 : 0;
  };
  Fields fields;
  const bool log = holds_across(text, [&](std::string_view line) { return rest_of_log(line) > 0; });
  if (!log && !holds_across(text, [&](std::string_view line) {
        const std::size_t rest = rest_of_count(line);
        split_fields(line.substr(rest), separator_of(line.substr(rest)), fields);
        return rest > 0 && std::ranges::all_of(fields, is_value);
      }))
    return;
  change_lines(text, [&](char* line, std::size_t length) {
    const std::string_view whole(line, length);
    const std::size_t rest = log ? rest_of_log(whole) : rest_of_count(whole);
    if (rest == 0) return;
    const char separator = separator_of(whole.substr(rest));
    split_fields(whole.substr(rest), separator, fields);
    if (!std::ranges::all_of(fields, is_value)) {
      std::fill_n(line, length, ' ');  // another line of the log
      return;
    }
    const bool labelled = label_length(fields[0]) > 0;
    const std::size_t end = end_of_digits(whole, log ? number : 0);
    if (log) std::fill_n(line, number, ' ');
    if (log && labelled) std::copy_n("ms=", number, line);
    std::fill(line + end, line + rest, ' ');
    line[end] = separator;
  });
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
      return k < fields.size() && fields.size() > k + 1 ? unquoted(fields[k].substr(0, 100)) : std::string();
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
    const auto many =
        std::ranges::count_if(rows, [&](const auto& one) { return std::regex_match(one.first, wanted); });
    if (others || rows.size() < 2 || many == static_cast<std::ptrdiff_t>(rows.size())) continue;
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

/// As many cells in each of a few lines, many more than there are lines: the first of each a name, or the
/// first line evenly rising times.
bool are_long_lines(const std::vector<Fields>& lines) {
  constexpr std::size_t fewest_cells = 64, most_lines = 64, fewest_times = 4;
  if (lines.size() < 2 || lines.size() > most_lines || lines[0].size() < fewest_cells) return false;
  if (lines[0].size() < fewest_times * lines.size()) return false;
  const bool named = !is_reading(lines[0][0]);
  std::vector<double> first_line;
  for (const Fields& cells : lines) {
    if (cells.size() != lines[0].size() || is_reading(cells[0]) == named) return false;
    for (std::size_t k = 1; k < cells.size(); ++k)
      if (!is_reading(cells[k])) return false;
  }
  for (const std::string_view cell : lines[0]) first_line.push_back(parse_number(cell).value);
  return named || runs_evenly(first_line);
}

}  // namespace

void bring_to_utf8(std::string& text) {
  constexpr std::size_t looked_at = 20000, fewest_in_word = 4;
  std::size_t run = 0, longest = 0, small = 0, high = 0;
  for (std::size_t k = 0; k < std::min(text.size(), looked_at); ++k) {
    const auto letter = static_cast<unsigned char>(text[k]);
    if (letter < 0x80) {
      run = 0;
      continue;
    }
    if (letter < 0xC0 &&
        std::string_view("\xA8\xB8\xB0\xB2\xB3\xB7\xB9\xAB\xBB").find(text[k]) == std::string_view::npos)
      return;  // of UTF-8, or of another alphabet
    ++high, small += letter >= 0xE0 ? 1 : 0;
    longest = std::max(longest, ++run);
  }
  if (longest < fewest_in_word || 3 * small < 2 * high) return;
  std::string found;
  found.reserve(text.size() + high);
  for (const char c : text) {
    const auto letter = static_cast<unsigned char>(c);
    const unsigned code = letter < 0x80    ? letter
                          : letter >= 0xC0 ? 0x410U + (letter - 0xC0U)
                          : letter == 0xA8 ? 0x401U
                          : letter == 0xB8 ? 0x451U
                          : letter == 0xB9 ? 0x2116U
                          : letter == 0xB2 ? 0xB2U  // written for a raised two
                                           : letter;
    if (code < 0x80)
      found += c;
    else if (code < 0x800)
      found += {static_cast<char>(0xC0 | code >> 6), static_cast<char>(0x80 | (code & 0x3F))};
    else
      found += {static_cast<char>(0xE0 | code >> 12), static_cast<char>(0x80 | (code >> 6 & 0x3F)),
                static_cast<char>(0x80 | (code & 0x3F))};
  }
  text = std::move(found);
}

bool turn_lines_to_columns(std::string& text) {
  constexpr std::size_t shortest = 128, most_lines = 64;
  if (std::min(text.find_first_of("\r\n"), text.size()) < shortest) return false;
  std::vector<Fields> lines;
  char separator = '\0';
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = take_line(rest);
    if (trimmed(line).empty()) continue;
    if (separator == '\0') separator = separator_of(line);
    split_fields(line, separator, lines.emplace_back());
    if (lines.size() > most_lines) return false;
  }
  if (!are_long_lines(lines)) return false;
  std::string turned;
  turned.reserve(text.size() + lines[0].size());
  for (std::size_t cell = 0; cell < lines[0].size(); ++cell)
    for (std::size_t k = 0; k < lines.size(); ++k) {
      turned += lines[k][cell];
      turned += k + 1 < lines.size() ? separator : '\n';
    }
  text = std::move(turned);
  return true;
}

std::optional<SensorRows> bring_to_fields(const std::string& file, const RecordFormat& format,
                                          std::string& text) {
  write_minus(text);
  part_stamps(text);
  part_log_prefixes(text);
  join_labels(text);
  if (format.header_lines > 0) return {};
  keep_one_sensor(file, text);
  const std::optional<SensorRows> sensors =
      format.separator == '\0' ? number_sensors(text) : std::optional<SensorRows>();
  if (format.separator == '\0') bring_pattern_to_fields(text);
  blank_words(text, format.separator);
  return sensors;
}

}  // namespace beamid::experiments
