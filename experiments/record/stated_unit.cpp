// The unit of motion that lines of text above the columns state for all of them: in a line for units, in a
// title, or beside the peaks of a strong-motion record.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "experiments/record/delimited_text.hpp"
#include "experiments/record/recognised_column.hpp"
#include "experiments/record/record_columns.hpp"
#include "experiments/record/stamps.hpp"
#include "experiments/record/units.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {

std::optional<MotionUnit> motion_unit(std::string_view written) {
  static const std::regex power(R"(\*\*|\^)"), second("seg|sec"), twice("/s/s"), raised("\xc2\xb2"),
      length(R"((um|mm|cm|m|ft|in)(?:(/s2|[.*]?s-2)|(/s|[.*]?s-1))?)"),
      gravity(R"((milli-?|m|u|%)?g(?:'?s|_n)?(?:/(10+))?)"), gal("(m?)gals?");
  std::string word = std::regex_replace(folded(written), power, "");
  word = std::regex_replace(std::regex_replace(word, raised, "2"), second, "s");
  word = std::regex_replace(word, twice, "/s2");
  std::smatch match;
  if (std::regex_match(word, match, gal))
    return MotionUnit{Quantity::acceleration, match[1].length() > 0 ? 1e-5 : 1e-2};
  if (std::regex_match(word, match, gravity)) {
    const std::string part = match[1];
    const double size = part.starts_with('m') ? 1e-3 : part == "u" ? 1e-6 : part == "%" ? 1e-2 : 1.0;
    return MotionUnit{
        Quantity::acceleration,
        size * standard_gravity / (match[2].matched ? parse_number(match[2].str()).value : 1.0)};
  }
  if (std::regex_match(word, match, length)) {
    const std::string unit = match[1];
    const Quantity quantity = match[2].matched   ? Quantity::acceleration
                              : match[3].matched ? Quantity::velocity
                                                 : Quantity::displacement;
    if (unit == "in" && quantity == Quantity::displacement) return {};  // the word
    return MotionUnit{quantity, unit == "um"   ? 1e-6
                                : unit == "mm" ? 1e-3
                                : unit == "cm" ? 1e-2
                                : unit == "ft" ? 0.3048
                                : unit == "in" ? 0.0254
                                               : 1.0};
  }
  if (const auto known = stated_unit(written); known && known->quantity)
    return MotionUnit{*known->quantity, known->factor};
  return {};
}

namespace {

// A line in words, without the signs around them, as views into it.
std::vector<std::string_view> words_of_line(std::string_view line) {
  constexpr std::string_view between = " \t,;:=()[]{}<>|\"#!";
  std::vector<std::string_view> words;
  for (std::size_t from = 0; (from = line.find_first_not_of(between, from)) != line.npos;) {
    const std::size_t end = std::min(line.find_first_of(between, from), line.size());
    std::string_view word = line.substr(from, end - from);
    from = end;
    while (word.size() > 1 && (word.ends_with('.') || word.ends_with('\''))) word.remove_suffix(1);
    while (word.size() > 1 && (word.front() == '\'' ||
                               (word.size() > 2 && std::string_view("*/%").find(word.front()) != word.npos)))
      word.remove_prefix(1);
    words.push_back(word);
  }
  return words;
}

bool is_motion(const std::string& word) {
  for (const std::string_view start : {"acc", "acel", "beschl", "vel", "disp", "despl", "motion"})
    if (word.starts_with(start) && word.find("ometer") == word.npos) return true;
  return word == "uncor" || word == "cor";
}

// Words that do not say of what else a unit is.
bool is_plain(const std::string& word) {
  static const std::set<std::string> list{
      "a",      "all",     "and",         "are",       "amplitude", "channel",  "channels", "component",
      "corr",   "data",    "daten",       "datos",     "de",        "del",      "der",      "des",
      "die",    "donnees", "du",          "e",         "east",      "en",       "et",       "filtered",
      "ground", "history", "horizontal",  "in",        "is",        "la",       "las",      "los",
      "north",  "of",      "processed",   "raw",       "readings",  "record",   "recorded", "records",
      "sensor", "series",  "signal",      "signals",   "sind",      "son",      "strong",   "the",
      "time",   "und",     "uncorrected", "corrected", "value",     "values",   "vertical", "x",
      "y",      "y-axis",  "z",           "histories", "valores",   "registro", "ns",       "ew",
      "ud"};
  return list.contains(word) || is_motion(word);
}

bool is_time_unit(std::string_view word) {
  return seconds_per_unit(word) || folded(word) == "sec" || folded(word).starts_with("second") ||
         folded(word) == "segundos";
}

// What one line states, if anything; `several` where it states two.
struct UnitLine {
  std::optional<MotionUnit> unit;
  bool several = false;

  void add(const MotionUnit& one) {
    several = several || (unit && *unit != one);
    if (!unit) unit = one;
  }
};

// "UNITS: cm/s^2", "# units: s, g, g", "UNITS ARE SECONDS AND G/10", "ACCELERATION TIME SERIES IN UNITS OF
// G", "UNIDADES DE LOS DATOS : Gal (cm/s/s)", "#AmplitudeUnit:  gal. DCoffset(corr)"; not "length units: mm".
UnitLine of_units(const std::vector<std::string_view>& words) {
  static const std::regex name(
      R"((?:amplitude|data|signal|value|y|acc[a-z]*)?[_-]?(?:units?(?:_?name)?(?:_[0-9]+)?|einheit(?:en)?|unites?|unidad(?:es)?|unita|unidades?))");
  UnitLine found;
  std::size_t at = 0;
  for (; at < words.size(); ++at) {
    const std::string word = folded(words[at]);
    if (std::regex_match(word, name)) {
      const std::string before = at > 0 ? folded(words[at - 1]) : "";
      if (before == "time" || before == "x") return found;  // of the abscissa
      break;
    }
    if (!is_plain(word) && word.find_first_not_of("0123456789.*/%") != word.npos) return found;
  }
  const auto is_motion_at = [&](std::size_t k) { return k < words.size() && is_motion(folded(words[k])); };
  const std::size_t number = is_motion_at(at + 2) && parse_number(words[at + 1]).finite ? 1 : 0;
  const std::size_t first = at + 1 + number;  // "ValueUnit;1;Velocity [mm/s]"
  for (at = first; at < words.size(); ++at) {
    const std::string word = folded(words[at]);
    if (const auto unit = motion_unit(words[at]))
      found.add(*unit);
    else if (const auto factor =
                 found.unit || is_plain(word) ? std::nullopt : convertible_unit(word, Quantity::acceleration))
      found.add({Quantity::acceleration, *factor});
    else if (!is_plain(word) && !is_time_unit(words[at]) && !is_other_unit(words[at]))
      break;
  }
  return found;
}

// "ACCELERATION TIME HISTORY IN G", "Ground acceleration (cm/s2)": nothing but words of motion.
UnitLine of_title(std::string_view line, const std::vector<std::string_view>& words) {
  UnitLine found;
  bool motion = false;
  for (std::size_t k = 0; k < words.size(); ++k) {
    const std::string word = folded(words[k]), before = k > 0 ? folded(words[k - 1]) : "";
    const bool in_brackets =
        words[k].data() > line.data() && (words[k].data()[-1] == '(' || words[k].data()[-1] == '[');
    const auto unit = before == "in" || before == "en" || in_brackets ? motion_unit(words[k]) : std::nullopt;
    if (unit)
      found.add(*unit);
    else if (!is_plain(word) && !is_time_unit(words[k]))
      return {};
    motion = motion || is_motion(word);
  }
  return motion ? found : UnitLine{};
}

// Peaks of acceleration, in their unit: "RAW PGA VALUES (gal) : (N-S) 1.22 (E-W) 1.21", "PGA_CM/S^2: 0.2",
// "Peak acceleration = 0.35 g at 12.3 sec". Of a range or a threshold there are none.
struct Peak {
  MotionUnit unit;
  std::string symbol;
  double size = 0.0;    // the largest, in that unit
  bool of_raw = false;  // of the columns as they are, by the form of AFAD
};

std::optional<Peak> peak_of(std::string_view line, const std::vector<std::string_view>& words) {
  static const std::regex peak(R"((?:^|[^a-z])(?:pga|peak|max[a-z]*)(?:[^a-z]|$))"),
      motion(R"(pga|acc|acel|beschl)"),
      others("range|scale|full|limit|trigger|thresh|sensor|resol|sensitiv|umbral|spectr|pgv|pgd");
  const std::string text = folded(line);
  if (!std::regex_search(text, peak) || !std::regex_search(text, motion) || std::regex_search(text, others))
    return {};
  std::optional<Peak> found;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (folded(words[k]) == "at") break;
    const ParsedNumber number = parse_number(words[k]);
    if (number.finite && found) found->size = std::max(found->size, std::abs(number.value));
    if (number.finite || found) continue;
    const std::size_t bar = words[k].rfind('_');
    const std::string_view spelled =
        bar == words[k].npos || motion_unit(words[k]) ? words[k] : words[k].substr(bar + 1);
    const auto unit = motion_unit(spelled);
    if (!unit || unit->first != Quantity::acceleration) continue;
    found = Peak{*unit, std::string(spelled), 0.0, text.find("raw pga values") != text.npos};
    if (const ParsedNumber before = k > 0 ? parse_number(words[k - 1]) : ParsedNumber{}; before.finite)
      found->size = std::abs(before.value);
  }
  return found && found->size > 0.0 ? found : std::nullopt;
}

// The largest distance of a signal of the file from zero or from its mean, whichever is closer to a peak.
double reach(const RecordTable& table, double peak) {
  double from_zero = 0.0, from_mean = 0.0;
  for (std::size_t index = 0; index < table.width(); ++index) {
    const std::vector<double>& values = table.columns[index];
    if (table.time == index || rises(values)) continue;
    double sum = 0.0, count = 0.0, most = 0.0, apart = 0.0;
    for (const double value : values)
      if (std::isfinite(value)) sum += value, count += 1.0, most = std::max(most, std::abs(value));
    for (const double value : values)
      if (std::isfinite(value)) apart = std::max(apart, std::abs(value - sum / count));
    from_zero = std::max(from_zero, most), from_mean = std::max(from_mean, apart);
  }
  const auto off = [&](double one) { return std::abs(std::log(std::max(one, 1e-300) / peak)); };
  return off(from_zero) < off(from_mean) ? from_zero : from_mean;
}

// Whether a channel of the file states no unit of its own.
bool lacks_unit(const RecordTable& table) {
  if (table.names.size() != table.width()) return true;
  for (std::size_t index = 0; index < table.width(); ++index) {
    if (table.time == index || rises(table.columns[index]) || stated_meaning(table, index)) continue;
    const auto found = recognised(table, index);
    if (found && found->kind == RecognisedColumn::Kind::signal && !found->states_unit) return true;
  }
  return false;
}

struct Stated {
  UnitLine statement;        // of lines for units, else of titles
  std::optional<Peak> peak;  // where neither states one
};

Stated stated_by(std::string_view above, std::size_t names_line) {
  constexpr std::size_t longest = 400;
  UnitLine units, titles;
  std::optional<Peak> peak;
  std::size_t number = 0;
  while (!above.empty()) {
    std::string_view line = above.substr(0, above.find_first_of("\r\n"));
    above.remove_prefix(line.size());
    above.remove_prefix(std::min(above.size(), std::size_t{above.starts_with("\r\n") ? 2u : 1u}));
    ++number;
    line = line.substr(0, longest);
    const std::vector<std::string_view> words = words_of_line(line);
    const UnitLine unit = of_units(words);
    if (unit.unit) units.add(*unit.unit), units.several = units.several || unit.several;
    if (number == names_line) continue;
    const UnitLine title = of_title(line, words);
    if (title.unit) titles.add(*title.unit), titles.several = titles.several || title.several;
    if (!peak) peak = peak_of(line, words);
  }
  if (units.unit) return {units, {}};
  if (titles.unit) return {titles, {}};
  return {{}, peak};
}

}  // namespace

std::optional<std::pair<Quantity, double>> unit_of_statement(std::string_view lines) {
  const UnitLine found = stated_by(lines, 0).statement;
  return found.several ? std::nullopt : found.unit;
}

void take_stated_unit(RecordTable& table, std::string_view above, bool described) {
  constexpr double alike = 2.0;  // peaks before and after a filter, or a mean that was taken off
  const auto [statement, peak] = stated_by(above, table.header_line);
  const auto is_question = [&](std::string sentence) {
    if (described || !lacks_unit(table)) return;
    table.stated_unit = MotionUnit{Quantity::acceleration, std::numeric_limits<double>::quiet_NaN()};
    table.warnings.push_back(std::move(sentence));
  };
  if (statement.several)
    is_question("The lines above the columns state several units, and none for one column alone.");
  else if (statement.unit)
    table.stated_unit = statement.unit;
  if (statement.unit || !peak) return;
  const double reached = reach(table, peak->size), ratio = reached / peak->size,
               in_si = reached / (peak->size * peak->unit.second);
  if (ratio <= alike && (peak->of_raw || ratio >= 1.0 / alike))
    table.stated_unit = peak->unit;
  else if (in_si < 1.0 / alike || in_si > alike)  // else in m/s2, for which they are taken
    is_question(
        fmt::format("The lines above the columns state a peak of {:.4g} {}, and the columns, which "
                    "state no unit, reach {:.4g}.",
                    peak->size, peak->symbol, reached));
}

}  // namespace beamid::experiments
