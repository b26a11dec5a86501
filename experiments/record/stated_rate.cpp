// What the lines above the columns of a text state of its sampling, and lines that are no rows.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "experiments/record/recognised_column.hpp"
#include "experiments/record/units.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {

SamplingName sampling_name(std::string_view name) {
  static const std::set<std::string> rates{"fs",
                                           "fsample",
                                           "fsamp",
                                           "sr",
                                           "samplerate",
                                           "samplingrate",
                                           "samprate",
                                           "sampleratehz",
                                           "samplingratehz",
                                           "samplefrequency",
                                           "samplefreq",
                                           "samplingfrequency",
                                           "samplingfreq",
                                           "sampfreq",
                                           "fshz",
                                           "sfreq",
                                           "srate",
                                           "samplespersecond",
                                           "samplerateinhz",
                                           "samplingratesps",
                                           "acquisitionrate",
                                           "acquisitionfrequency",
                                           "scanrate",
                                           "datarate",
                                           "outputdatarate",
                                           "rate"};
  static const std::set<std::string> intervals{"dt",
                                               "ts",
                                               "deltat",
                                               "deltax",
                                               "tinterval",
                                               "increment",
                                               "hresolution",
                                               "xincrement",
                                               "xinc",
                                               "tinc",
                                               "wfincrement",
                                               "timestep",
                                               "timeincrement",
                                               "samplinginterval",
                                               "samplingintervals",
                                               "sampleinterval",
                                               "sampleperiod",
                                               "dts",
                                               "dtsec",
                                               "sampletime",
                                               "samplingtime",
                                               "samplingintervalsec",
                                               "samplingperiod"};
  std::string letters;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)))
      letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return rates.contains(letters)       ? SamplingName::rate
         : intervals.contains(letters) ? SamplingName::interval
                                       : SamplingName::none;
}

namespace {

/// Cells that name an interval, and a number in the next cell or in that below.
std::optional<double> interval_in_cells(std::string_view text, char decimal) {
  std::vector<std::string_view> cells, above;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find_first_of("\r\n"));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (trimmed(line).empty()) continue;
    std::swap(cells, above);
    split_fields(line, separator_of(line), cells);
    const auto positive = [&](std::string_view cell) {
      const ParsedNumber number = parse_number(cell, decimal);
      return number.finite && number.value > 0.0 ? std::optional(number.value) : std::nullopt;
    };
    const auto names_interval = [](std::string_view cell) {
      return sampling_name(cell) == SamplingName::interval;
    };
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (k + 1 < cells.size() && names_interval(cells[k]))
        if (const auto number = positive(cells[k + 1])) {
          const std::string_view behind = k + 2 < cells.size() ? cells[k + 2] : "";
          const auto seconds = seconds_per_unit(behind);
          if (!seconds && (stated_unit(behind) || is_other_unit(behind))) continue;
          return *number * seconds.value_or(1.0);
        }
      if (k < above.size() && names_interval(above[k]))
        if (const auto number = positive(cells[k])) return number;
    }
  }
  return {};
}

// "400", "0,4", "1.2e3"; absent where its sign may part thousands: "1,200", and "1.200", for few records
// have 1.2 Hz.
std::optional<double> stated_number(std::string text, char decimal) {
  const std::size_t sign = text.find_first_of(".,");
  if (sign == text.npos) return parse_number(text).value;
  const std::size_t end = std::min(text.find_first_not_of("0123456789", sign + 1), text.size());
  if (end < text.size() && text[end] != 'e') return {};
  const bool thousands = end - sign == 4 && sign > 0 && sign <= 3 && text[0] != '0',
             strange = text[sign] != decimal;
  text[sign] = '.';
  const ParsedNumber number = parse_number(text);
  constexpr double slow = 10.0;
  if (!number.finite || (thousands && (number.value < slow || (strange && decimal == ',')))) return {};
  return thousands && strange ? std::nullopt : std::optional(number.value);
}

// What stands behind a word for a rate or an interval: signs, a number, a unit before or behind it.
struct Statement {
  double value = 0.0;
  std::string unit;          // small letters
  bool other_thing = false;  // a word stands directly behind the number
};

std::optional<Statement> statement_behind(std::string_view rest, char decimal) {
  static const std::regex form(
      "^([^0-9]{0,24}?)([0-9][0-9.,]*(?:e[-+]?[0-9]+)?|[.][0-9]+)(?![0-9:])\"?(\\s*)([,;\t]?\\s*\"?)([a-"
      "z\xc2\xb5\xce\xbc/]*)");
  std::match_results<std::string_view::const_iterator> match;
  if (!std::regex_search(rest.begin(), rest.end(), match, form)) return {};
  std::string digits = match[2];
  if (match[1].str().find(',') != std::string::npos)
    digits.resize(std::min(digits.find(','), digits.size()));  // cells
  while (digits.ends_with('.') || digits.ends_with(',')) digits.pop_back();
  // "51 200", "12'800", "2*200", "> 400", "400 -> 200", "(max)": not this number alone, or none of the
  // record's
  static const std::regex more(R"(^(?: ?['_*^]| ?-|[ \xc2\xe2][^0-9a-z]*[0-9]{3}(?![0-9])))"),
      strange(R"([<>*]|max|min|code|setting|index|number|mode|video|camera|audio|gps|display)");
  const std::string behind(match[2].second, rest.end());
  if (std::regex_search(behind, more) || std::regex_search(match[1].first, match[1].second, strange))
    return {};
  const auto value = stated_number(digits, decimal);
  if (!value || !(*value > 0.0)) return {};
  static const std::regex before("(?:^|[^a-z])(k?hz|[mun]?s|\xc2\xb5s|\xce\xbcs|sec|seconds)(?![a-z])");
  const std::string between = match[1];
  if (std::smatch unit; std::regex_search(between, unit, before)) return Statement{*value, unit[1], false};
  const bool apart = match[4].length() > 0 || digits.size() < static_cast<std::size_t>(match[2].length());
  return Statement{*value, match[5], !apart && match[5].length() > 0};
}

std::optional<double> samples_per_second(const std::string& unit) {
  static const std::set<std::string> ones{
      "hz", "hertz", "sps", "s/s", "sa/s", "samples/s", "samples/sec", "samples/second", "scans/s", "fps"},
      thousands{"khz", "ks/s", "ksps", "ksa/s"};
  return ones.contains(unit)        ? std::optional(1.0)
         : thousands.contains(unit) ? std::optional(1e3)
                                    : std::nullopt;
}

// Of one line, the rate that a word for one states, or for an interval; below 0 where it states two.
std::optional<double> rate_of_line(const std::string& line, char decimal) {
  static const std::regex sure(
      R"(\b(samp\w*[ _-]*(?:rate|freq\w*)|(?:samples|points) ?(?:/|per) ?sec(?:ond)?|abtast(?:rate|frequenz)|messrate|odr|fps|fs|rate(?= [0-9.]+, overflows)|)"
      R"((?:fre[cq]uen\w*|cadence|taxa|tasa|velocid?a\w*|vel\.) (?:d'echantillonnage|d'acquisition|de muestreo|)"
      R"(di campionamento|de amostragem))(?![a-z]))"),
      with_unit(
          R"((?:\b(?:scan|acquisition|logging|recording|output data|output|data)[ _-]*(?:rate|frequency)|^\W*rate|^// *update rate(?=: *[0-9.]+ ?hz *$)|\bdate format \S+ at|\bsampl(?:ing|ed))\b)"),
      period(
          R"(\b(dt|delta[ _]?t|delta[ _]?x(?=[^0-9]*[0-9.]+ ?[mun]?s\b)|[tx]inc(?:r|rement)?|hresolution|sampl\w*[ _-]*(?:interval|period|time|cycle)|)"
          R"(abtast(?:intervall|zeit)|time[ _]?step|intervals of|(?:equal|even) spacing of|(?:equal|even)ly spaced at|dx ?[\[(]s[\])]|(?:recording|logging|time) interval|^\W*interval|)"
          R"(pas de temps|paso de tiempo|(?:periode|pas|interval(?:le|l?o|a)|periodo|pass?o) (?:d'echantillonnage|)"
          R"(de muestreo|di campionamento|de amostragem))(?![a-z]))"),
      alone(R"(\b([0-9]+(?:\.[0-9]+)?) ?(?:sps|samples? ?(?:/|per) ?s(?:ec(?:ond)?)?)\b)"),
      of_another(
          R"(\b(gps|original|recommended|default|nominal|nyquist|audio|gyro\w*|camera|magneto\w*|temperature|old|)"
          R"(update|trigger|sweep|max\w*|min|minimum|total|aggregate|adc|internal|refresh|display|)"
          R"(video|screen|filter|baud|frame|bit|over)[ _-]*(?:[a-z]+[ _-]+)?$)");
  constexpr double slowest = 1.0, longest_bare = 0.5, longest_time = 0.1;  // [Hz], [s], [s]
  std::smatch match;
  std::optional<double> found;
  bool contradicts = false;
  const auto take = [&](double rate) {
    constexpr double tolerated = 0.02;
    if (!(rate > slowest)) return;
    contradicts = contradicts || (found && std::abs(rate / *found - 1.0) > tolerated);
    found = rate;
  };
  for (const std::regex* const word : {&sure, &with_unit, &period}) {
    if (!std::regex_search(line, match, *word) || std::regex_search(match.prefix().str(), of_another))
      continue;
    const std::string rest = match.suffix();
    const auto stated = statement_behind(rest, decimal);
    if (!stated) continue;
    if (word == &period) {
      const auto seconds = seconds_per_unit(stated->unit);
      if (!seconds && (stated->other_thing || stated->value > longest_bare)) continue;
      const double interval = stated->value * seconds.value_or(1.0);
      if (match.str().ends_with("time") && interval > longest_time) continue;  // of the whole record
      take(1.0 / interval);
      continue;
    }
    static const std::regex second(R"(([0-9]+(?:\.[0-9]+)?) ?k?hz)"),
        explained(R"(filter|pass|band|range|resol|cut|corner)"), of_all(R"(total|[0-9] ?ch\b)");
    const std::string behind = rest.substr(std::min(rest.size(), rest.find("hz") + 2));
    if (std::regex_search(behind, of_all)) return -1.0;
    if (std::smatch other; std::regex_search(behind, other, second) &&
                           parse_number(other[1].str()).value != stated->value &&
                           !std::regex_search(behind, explained))
      return -1.0;  // which of them
    const auto unit = samples_per_second(stated->unit);
    if (!unit && (word == &with_unit || stated->other_thing)) continue;
    take(stated->value * unit.value_or(1.0));
  }
  static const std::regex of_others(
      R"(\b(?:max|min|total|aggregate|up to|gps|trigger|original|recommended)\b)");
  if (!found && std::regex_search(line, match, alone) && !std::regex_search(match.prefix().str(), of_others))
    take(parse_number(match[1].str()).value);
  return contradicts ? -1.0 : found;
}

/// A digit, and a word: two letters one after another.
bool can_state_a_rate(std::string_view line) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  return std::ranges::any_of(line, [](char c) { return c >= '0' && c <= '9'; }) &&
         std::ranges::adjacent_find(line, [&](char a, char b) { return is_letter(a) && is_letter(b); }) !=
             line.end();
}

}  // namespace

std::optional<double> stated_rate(std::string_view lines, char decimal) {
  static const std::regex fewer(
      R"(\b(?:decim\w*|downsampl\w*|averag\w*|resampl\w*|reduced by|every)[^0-9\n]{0,20}([0-9]+))");
  const std::string text = folded(lines);
  if (std::smatch match; std::regex_search(text, match, fewer) && parse_number(match[1].str()).value > 1.0)
    return {};
  std::optional<double> found;
  for (std::string_view rest = text; !rest.empty();) {
    constexpr std::size_t longest = 400;
    const std::string_view line = rest.substr(0, rest.find_first_of("\r\n"));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    static const std::regex channels(R"(, *c[0-9]+ ?- ?c?[0-9]+)");  // "INTERVALO DE MUESTREO, C1-C6 (s)"
    if (line.size() > longest || !can_state_a_rate(line)) continue;  // one would recurse per letter
    const auto rate = rate_of_line(std::regex_replace(std::string(line), channels, ""), decimal);
    constexpr double tolerated = 0.02;
    if (rate && *rate < 0.0) return {};
    if (rate && found && std::abs(*rate / *found - 1.0) > tolerated) return {};  // which of them
    if (rate && !found) found = rate;
  }
  if (found) return found;
  const auto interval = interval_in_cells(lines, decimal);
  return interval && *interval < 1.0 ? std::optional(1.0 / *interval) : std::nullopt;
}

bool is_statement(std::string_view line) {
  static const std::regex form(R"(^[^0-9,;\t:=]*[A-Za-z][^,;\t:=]*[:=]\s*"?(?:\+/-\s*)?[-+.]?[0-9])");
  if (line.starts_with("Unnamed: ")) return false;  // columns without names, of pandas
  return line.size() < 400 && (std::regex_search(line.begin(), line.end(), form) || stated_rate(line));
}

/// some begin with 0.
bool is_column_with_commas(std::string_view text) {
  constexpr int looked_at = 50, fewest = 4;
  static const std::regex form(R"(^([-+]?[0-9]{1,4}),([0-9]{2,})([eE][-+]?[0-9]+)?$)");
  std::string_view rest = text.substr(std::min(text.find_first_of("\r\n", text.size() / 2), text.size()));
  bool led_by_zero = false, counts = true;
  std::size_t digits = 0;
  std::optional<double> before;
  int lines = 0;
  while (lines < looked_at && !rest.empty()) {
    const std::string line(trimmed(rest.substr(0, rest.find_first_of("\r\n"))));
    rest.remove_prefix(std::min(rest.size(), std::min(rest.find_first_of("\r\n"), rest.size() - 1) + 1));
    if (line.empty()) continue;
    std::smatch match;
    if (rest.empty() && !text.ends_with('\n')) break;  // it may be cut
    if (line.size() > 40 || !std::regex_match(line, match, form)) return false;
    const std::string whole = match[1], part = match[2];
    if (digits != 0 && part.size() != digits) return false;
    digits = part.size();
    led_by_zero = led_by_zero || part.front() == '0' || whole == "-0" || match[3].length() > 0;
    const double value = parse_number(whole).value;
    counts = counts && (!before || value > *before);
    before = value;
    ++lines;
  }
  return lines >= fewest && led_by_zero && !counts;
}

}  // namespace beamid::experiments
