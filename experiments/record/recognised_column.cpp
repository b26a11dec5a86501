#include "experiments/record/recognised_column.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <regex>
#include <set>
#include <utility>
#include <vector>

#include "experiments/record/units.hpp"

namespace beamid::experiments {
namespace {

using Kind = RecognisedColumn::Kind;

// Small letters, without accents: "Déplacement" -> "deplacement".
std::string folded(std::string_view text) {
  static const std::vector<std::pair<std::string_view, std::string_view>> accents{
      {"ä", "a"}, {"ö", "o"}, {"ü", "u"}, {"Ä", "a"}, {"Ö", "o"}, {"Ü", "u"}, {"ß", "ss"},
      {"à", "a"}, {"á", "a"}, {"â", "a"}, {"ã", "a"}, {"ç", "c"}, {"é", "e"}, {"è", "e"},
      {"ê", "e"}, {"í", "i"}, {"ì", "i"}, {"ó", "o"}, {"ò", "o"}, {"ô", "o"}, {"õ", "o"},
      {"ú", "u"}, {"ù", "u"}, {"ñ", "n"}, {"É", "e"}, {"Á", "a"}, {"À", "a"}};
  std::string result(text);
  for (const auto& [from, to] : accents)
    for (std::size_t at; (at = result.find(from)) != std::string::npos;) result.replace(at, from.size(), to);
  for (char& letter : result) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return result;
}

// "AccX" and "Linear Acceleration x" -> {"acc", "x"}, {"linear", "acceleration", "x"}; "gFx" stays one word.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words;
  std::string word;
  const auto close = [&] {
    if (!word.empty()) words.push_back(folded(word));
    word.clear();
  };
  const auto is = [](char c, int (*what)(int)) { return what(static_cast<unsigned char>(c)) != 0; };
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    const bool letter = is(c, std::isalpha) || (static_cast<unsigned char>(c) & 0x80) != 0;
    if (!letter) {
      close();
      continue;
    }
    if (word.size() > 2 && is(c, std::isupper) && is(name[i - 1], std::islower)) close();
    word += c;
  }
  close();
  return words;
}

bool begins(const std::string& word, std::initializer_list<std::string_view> starts) {
  return std::any_of(starts.begin(), starts.end(),
                     [&](std::string_view start) { return word.starts_with(start); });
}

bool any_word(const std::vector<std::string>& words, const std::set<std::string>& list) {
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& word) { return list.contains(word); });
}

const std::set<std::string> times{
    "t",     "time",     "times",   "timestamp", "zeit",     "zeitstempel", "temps",    "tiempo",
    "tempo", "seconds",  "secs",    "elapsed",   "sekunden", "secondes",    "segundos", "secondi",
    "date",  "datetime", "datum",   "fecha",     "uhrzeit",  "epoch",       "unix",     "second",
    "sec",   "sekunde",  "seconde", "segundo",   "secondo",  "hora",        "heure",    "ora"};
const std::set<std::string> counts{
    "sample",        "samples", "index",       "idx",      "n",       "nr",     "no",     "packet",
    "packetcounter", "counter", "count",       "row",      "id",      "i",      "k",      "probe",
    "abtastwert",    "muestra", "echantillon", "campione", "amostra", "nummer", "number", "point"};
const std::set<std::string> no_motion{
    "euler",      "roll",    "pitch",        "yaw",     "gyr",        "gyro",     "gyroscope",
    "mag",        "magnet",  "magnetometer", "quat",    "quaternion", "temp",     "temperature",
    "temperatur", "heading", "azimuth",      "battery", "pressure",   "humidity", "status"};

std::optional<Quantity> quantity_of(const std::vector<std::string>& words) {
  const bool base = any_word(words, {"base", "ground", "table", "boden", "sol", "suelo", "suolo"});
  for (const std::string& word : words) {
    static const std::set<std::string> axes{"a",   "ax",  "ay",   "az",   "gfx",
                                            "gfy", "gfz", "accx", "accy", "accz"};
    if (axes.contains(word) || begins(word, {"acc", "beschl", "acel"}))
      return base ? Quantity::base_acceleration : Quantity::acceleration;
    if (begins(word, {"vel", "geschw", "vitesse", "veloc"}) || word == "v") return Quantity::velocity;
    if (begins(word, {"disp", "depla", "despl", "spost", "desloc", "ausl", "verschieb", "position"}) ||
        word == "weg" || word == "u")
      return Quantity::displacement;
    if (begins(word, {"force", "kraft", "fuerza", "forza", "forca", "load", "hammer"}) || word == "f")
      return Quantity::force;
    if (begins(word, {"strain", "dehnung", "eps", "deform"})) return Quantity::strain;
  }
  return {};
}

// A name and the unit that stands in or behind it.
std::pair<std::string, std::string> parted(std::string_view name) {
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    const std::size_t from = name.rfind(open), to = name.rfind(close);
    if (from != std::string_view::npos && to != std::string_view::npos && to > from)
      return {std::string(name.substr(0, from)) + std::string(name.substr(to + 1)),
              std::string(name.substr(from + 1, to - from - 1))};
  }
  for (std::size_t at = name.size(); at-- > 1;) {
    if (name[at] != '/' && name[at] != ',' && name[at] != '_' && name[at] != ' ') continue;
    std::string_view unit = name.substr(at + 1);
    unit.remove_prefix(std::min(unit.find_first_not_of(' '), unit.size()));
    const bool slash_of_unit = name[at] == '/' && stated_unit(name.substr(name.find_last_of(",_ ", at) + 1));
    if (!unit.empty() && !slash_of_unit && stated_unit(unit))
      return {std::string(name.substr(0, at)), std::string(unit)};
  }
  return {std::string(name), ""};
}

// Units of time that no channel has.
std::optional<double> seconds_per_unit(std::string_view unit) {
  static const std::vector<std::pair<std::string_view, double>> more{
      {"ns", 1e-9}, {"min", 60.0}, {"h", 3600.0}, {"µs", 1e-6}, {"μs", 1e-6}};
  for (const auto& [symbol, seconds] : more)
    if (unit == symbol) return seconds;
  const auto stated = stated_unit(unit);
  return stated && !stated->quantity ? std::optional(stated->factor) : std::nullopt;
}

// mg and counts beside what stated_unit() knows.
std::optional<StatedUnit> unit_of(const std::string& unit) {
  if (unit == "mg") return StatedUnit{Quantity::acceleration, 1e-3 * standard_gravity};
  if (unit == "G") return StatedUnit{Quantity::acceleration, standard_gravity};
  if (unit == "microstrain" || unit == "µε" || unit == "με" || unit == "ue")
    return StatedUnit{Quantity::strain, 1e-6};
  return stated_unit(unit);
}

}  // namespace

std::optional<RecognisedColumn> recognise_column(std::string_view name, std::string_view unit) {
  if (name.find("_per_") != std::string_view::npos) return {};  // of this project's own kind
  auto [plain, stated] = parted(name);
  if (!unit.empty()) stated = std::string(unit);
  const std::vector<std::string> words = words_of(plain);
  if (plain.find("SampleTimeFine") != std::string::npos)
    return RecognisedColumn{Kind::time, {}, 1e-6, true, true};
  RecognisedColumn found;
  if (const auto seconds = seconds_per_unit(stated); any_word(words, times) && (stated.empty() || seconds)) {
    found.kind = Kind::time;
    found.factor = seconds.value_or(1.0);
    found.states_unit = seconds.has_value();
    return found;
  }
  const auto quantity = quantity_of(words);
  if (!quantity && any_word(words, no_motion)) return RecognisedColumn{Kind::other};
  if (!quantity && stated.empty() && any_word(words, counts)) return RecognisedColumn{Kind::count};
  const auto known = unit_of(stated);
  if (!quantity && !stated.empty() &&
      (stated.find("deg") != std::string::npos || stated.find("rad") != std::string::npos ||
       stated.find("°") != std::string::npos || stated == "T" || stated == "uT"))
    return RecognisedColumn{Kind::other};
  found.states_quantity = quantity || (known && known->quantity);
  found.quantity = quantity                   ? *quantity
                   : known && known->quantity ? *known->quantity
                                              : Quantity::acceleration;
  const Quantity in_units_of =
      found.quantity == Quantity::base_acceleration ? Quantity::acceleration : found.quantity;
  if (known && known->quantity == in_units_of) {
    found.factor = known->factor;
    found.states_unit = true;
  } else if (any_word(words, {"gfx", "gfy", "gfz"})) {
    found.factor = standard_gravity;
    found.states_unit = true;
  }
  return found;
}

bool names_columns(const std::vector<std::string_view>& fields) {
  bool named = false;
  for (const std::string_view field : fields) {
    const std::string text(unquoted(field));
    if (unit_of(text) || seconds_per_unit(text)) return false;
    const auto found = recognise_column(text, "");
    named = named || !found || found->states_quantity || found->kind == RecognisedColumn::Kind::time;
  }
  return named;
}

std::optional<double> stated_rate(std::string_view lines) {
  static const std::regex rate(
      R"((?:sampl\w*[ _-]*(?:rate|freq\w*)|abtastrate|abtastfrequenz|\bfs\b|\brate\b)[^0-9\n]{0,20}([0-9]+(?:\.[0-9]+)?(?:[eE][-+]?[0-9]+)?)\s*(k?)hz?)",
      std::regex::icase),
      bare(R"((?:\bfs\b|sampl\w*[ _-]*(?:rate|freq\w*))\s*[:=]\s*([0-9]+(?:\.[0-9]+)?(?:[eE][-+]?[0-9]+)?))",
           std::regex::icase),
      interval(
          R"((?:\bdt\b|delta[ _]?t|sampl\w*[ _-]*(?:interval|period)|time[ _]?step)[^0-9\n]{0,12}([0-9]*\.?[0-9]+(?:[eE][-+]?[0-9]+)?)\s*(m?)s?)",
          std::regex::icase);
  const std::string text(lines);
  std::smatch match;
  double found = 0.0;
  if (std::regex_search(text, match, rate))
    found = std::stod(match[1]) * (match[2].length() > 0 ? 1e3 : 1.0);
  else if (std::regex_search(text, match, bare))
    found = std::stod(match[1]);
  else if (std::regex_search(text, match, interval) && std::stod(match[1]) > 0.0)
    found = 1.0 / (std::stod(match[1]) * (match[2].length() > 0 ? 1e-3 : 1.0));
  return found > 0.0 ? std::optional(found) : std::nullopt;
}

std::optional<double> seconds_of_stamp(std::string_view text) {
  // Beginning as 2026-11-26T10:00:00; what follows are a fraction and an offset.
  const auto number = [&](std::size_t at, std::size_t digits) -> int {
    int value = -1;
    if (at + digits > text.size()) return -1;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + at + digits, value);
    return error == std::errc() && end == text.data() + at + digits ? value : -1;
  };
  if (text.size() < 19 || (text[4] != '-' && text[4] != '/') || text[7] != text[4] ||
      (text[10] != 'T' && text[10] != ' ') || text[13] != ':' || text[16] != ':')
    return {};
  const int year = number(0, 4), month = number(5, 2), day = number(8, 2), hour = number(11, 2),
            minute = number(14, 2), second = number(17, 2);
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (year < 0 || month < 0 || day < 0 || !date.ok() || hour < 0 || minute < 0 || second < 0) return {};
  double fraction = 0.0, place = 0.1;
  std::size_t at = 19;
  if (at < text.size() && (text[at] == '.' || text[at] == ','))
    for (++at; at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])); ++at, place *= 0.1)
      fraction += place * (text[at] - '0');
  double offset = 0.0;
  if (at < text.size() && (text[at] == '+' || text[at] == '-')) {
    const int hours = number(at + 1, 2),
              minutes = std::max(0, number(at + (text.find(':', at) != std::string_view::npos ? 4 : 3), 2));
    if (hours >= 0) offset = (text[at] == '-' ? -1.0 : 1.0) * (3600.0 * hours + 60.0 * minutes);
  }
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return 86400.0 * static_cast<double>(days) + 3600.0 * hour + 60.0 * minute + second + fraction - offset;
}

std::optional<double> seconds_of_day(std::string_view text) {
  const std::size_t first = text.find(':'),
                    second = first == std::string_view::npos ? first : text.find(':', first + 1);
  if (first == 0 || first > 2 || second != first + 3 || text.size() < second + 3) return {};
  double parts[3];
  const std::string_view fields[] = {text.substr(0, first), text.substr(first + 1, 2),
                                     text.substr(second + 1)};
  for (int i = 0; i < 3; ++i) {
    std::string field(fields[i]);
    std::replace(field.begin(), field.end(), ',', '.');
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), parts[i]);
    if (error != std::errc() || end != field.data() + field.size() || !(parts[i] >= 0.0)) return {};
  }
  if (parts[0] > 24.0 || parts[1] >= 60.0 || parts[2] >= 61.0) return {};
  return 3600.0 * parts[0] + 60.0 * parts[1] + parts[2];
}

bool is_date(std::string_view text) {
  static const std::regex date(R"((\d{4}[-/.]\d{1,2}[-/.]\d{1,2}|\d{1,2}[-/.]\d{1,2}[-/.]\d{2,4}))");
  return text.size() >= 6 && text.size() <= 10 && std::regex_match(text.begin(), text.end(), date);
}

}  // namespace beamid::experiments
