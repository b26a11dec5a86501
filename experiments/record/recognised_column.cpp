#include "experiments/record/recognised_column.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <regex>
#include <set>
#include <utility>
#include <vector>

#include "experiments/record/units.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {

using Kind = RecognisedColumn::Kind;

std::string folded(std::string_view text) {
  static const std::vector<std::pair<std::string_view, std::string_view>> accents{
      {"äàáâãåąÄÁÀ", "a"}, {"çćčČ", "c"},    {"éèêęěÉ", "e"},   {"ğ", "g"},   {"íìîıİ", "i"},
      {"ł", "l"},          {"ñń", "n"},      {"öóòôõøőÖ", "o"}, {"řŘ", "r"},  {"śşšșŚŞ", "s"},
      {"ț", "t"},          {"üúùûůűÜ", "u"}, {"ý", "y"},        {"żźž", "z"}, {"ß", "ss"}};
  std::string result(text);
  for (const auto& [letters, to] : accents)
    for (std::size_t letter = 0; letter < letters.size(); letter += 2)  // of two bytes each
      for (std::size_t at; (at = result.find(letters.substr(letter, 2))) != std::string::npos;)
        result.replace(at, 2, to);
  for (char& letter : result) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return result;
}

namespace {

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
    "t",       "time",  "stamp",     "times",   "timestamp", "zeit",     "zeitstempel", "temps",
    "tiempo",  "tempo", "seconds",   "secs",    "elapsed",   "sekunden", "secondes",    "segundos",
    "secondi", "date",  "datetime",  "datum",   "fecha",     "uhrzeit",  "epoch",       "unix",
    "second",  "sec",   "sekunde",   "seconde", "segundo",   "secondo",  "hora",        "heure",
    "ora",     "tijd",  "tid",       "aika",    "czas",      "时间",     "時間",        "時刻",
    "время",   "Время", "zeitpunkt", "uptime",  "ts",        "ticks",    "laufzeit",    "tow",
    "timer",   "zaman", "cas",       "ido",     "timp"};
// Time, and its unit [s].
const std::vector<std::pair<std::string_view, double>> clocks{
    {"millis", 1e-3},        {"milliseconds", 1e-3}, {"msec", 1e-3},          {"micros", 1e-6},
    {"microseconds", 1e-6},  {"usec", 1e-6},         {"nanos", 1e-9},         {"nanoseconds", 1e-9},
    {"minutes", 60.0},       {"nanosec", 1e-9},      {"millisekunden", 1e-3}, {"mikrosekunden", 1e-6},
    {"millisecondes", 1e-3}, {"millisecondi", 1e-3}, {"milisegundos", 1e-3},  {"milissegundos", 1e-3},
    {"heures", 3600.0},      {"horas", 3600.0},      {"ore", 3600.0},         {"microsegundos", 1e-6},
    {"hours", 3600.0},       {"stunden", 3600.0},    {"minuten", 60.0},       {"days", 86400.0}};
const std::set<std::string> counts{"sample",      "samples",  "index",   "idx",           "n",
                                   "nr",          "no",       "packet",  "packetcounter", "seq",
                                   "sequence",    "counter",  "count",   "row",           "id",
                                   "i",           "k",        "probe",   "abtastwert",    "muestra",
                                   "echantillon", "campione", "amostra", "nummer",        "number",
                                   "point"};
const std::set<std::string> no_motion{
    "euler",       "roll",        "pitch",        "yaw",      "gyr",        "gyro",     "gyroscope",
    "mag",         "magnet",      "magnetometer", "quat",     "quaternion", "temp",     "temperature",
    "temperatur",  "heading",     "azimuth",      "battery",  "pressure",   "humidity", "status",
    "light",       "sound",       "altitude",     "latitude", "longitude",  "gps",      "proximity",
    "druck",       "feuchte",     "helligkeit",   "current",  "rpm",        "weight",   "gewicht",
    "batt",        "vbat",        "vbatt",        "ptemp",    "utc",        "speed",    "lat",
    "lon",         "lng",         "label",        "state",    "gmt",        "rotation", "moment",
    "torque",      "rssi",        "trigger",      "trig",     "flag",       "flags",    "valid",
    "quality",     "steps",       "heart",        "accuracy", "tacho",      "crc",      "checksum",
    "marker",      "event",       "events",       "mic",      "micl",       "exg",      "emg",
    "ecg",         "eeg",         "eog",          "ppg",      "gsr",        "eda",      "spo2",
    "hour",        "minute",      "millisecond",  "day",      "month",      "year",     "week",
    "ratio",       "age",         "sdn",          "sde",      "sdu",        "sdne",     "sdeu",
    "sdun",        "sden",        "sdnu",         "sdue",     "hdop",       "pdop",     "vdop",
    "Температура", "температура", "Влажность",    "Давление"};
// Of these not even with a quantity behind them: "angular_velocity".
const std::set<std::string> no_motion_at_all{"angular",    "orientation", "gyro",     "gyroscope", "euler",
                                             "quaternion", "battery",     "rotation", "wind",      "cpu"};
const std::set<std::string> readings{"V", "mV", "uV", "LSB", "counts"};  // of a sensor of motion
// These, and units of what is no motion.
const std::set<std::string> other_units{
    "lux", "lx",  "dB",    "dBA",    "%",       "°C",     "degC",  "C",   "K",   "hPa",   "Pa",
    "V",   "mV",  "uV",    "LSB",    "counts",  "kPa",    "mbar",  "bar", "rpm", "RPM",   "µT",
    "uT",  "T",   "A",     "mA",     "Hz",      "W",      "km/h",  "°",   "deg", "lumen", "dps",
    "dBm", "bpm", "MPa",   "GPa",    "N/mm2",   "Nm",     "kNm",   "Ohm", "kV",  "kHz",   "degF",
    "°F",  "rad", "rad/s", "rad/s2", "rad/s^2", "rad/s²", "deg/s", "°/s"};

std::optional<Quantity> quantity_of(const std::vector<std::string>& words, std::string_view name) {
  const bool compass = words.size() == 2 && words[0].size() == 1 && words[1].size() == 1;  // "U-D"
  const bool base = any_word(words, {"base", "ground", "table", "boden", "sol", "suelo", "suolo"});
  for (const std::string& word : words) {
    static const std::set<std::string> axes{"a",   "ax",  "ay",   "az",   "gfx",
                                            "gfy", "gfz", "accx", "accy", "accz"};
    if (axes.contains(word) || begins(word, {"acc", "beschl", "acel", "versnelling", "przysp", "ivme",
                                             "zrychl", "ускор", "Ускор", "加速度"}))
      return base ? Quantity::base_acceleration : Quantity::acceleration;
    if (begins(word, {"vel", "geschw", "vitesse", "veloc", "snelheid", "predkosc", "hastighe", "rychlost",
                      "скорост", "Скорост"}) ||
        word == "hiz" || (word == "v" && name.find('V') == name.npos))
      return Quantity::velocity;
    if (begins(word, {"disp", "depla", "despl", "spost", "desloc", "ausl", "verschieb", "position", "defl",
                      "verplaats", "przemieszcz", "degistirme", "forskju", "forsky", "перемещ", "Перемещ"}) ||
        word == "weg" || (word == "u" && !compass))
      return Quantity::displacement;
    if (begins(word, {"force", "kraft", "fuerza", "forza", "forca", "load", "hammer", "kracht", "kuvvet"}) ||
        word == "f" || word == "sila")
      return Quantity::force;
    if (begins(word, {"strain", "dehnung", "eps", "deform", "odksztalc", "gerinim", "tojning"}))
      return Quantity::strain;
  }
  return {};
}

// mg and counts beside those of stated_unit().
std::optional<StatedUnit> unit_of(const std::string& unit) {
  static const std::set<std::string> milligravities{"mg", "mG", "milli-g", "milli g", "mgn"},
      gravities{"g0",  "gravity", "g pk", "g peak", "g rms",          "g's",           "gs",
                "g_n", "G's",     "Gs",   "G",      "g\xe2\x80\x99s", "G\xe2\x80\x99s"};
  if (milligravities.contains(unit)) return StatedUnit{Quantity::acceleration, 1e-3 * standard_gravity};
  if (unit == "mGal" || unit == "mgal") return StatedUnit{Quantity::acceleration, 1e-5};
  if (gravities.contains(unit)) return StatedUnit{Quantity::acceleration, standard_gravity};
  if (unit == "ips" || unit == "IPS") return StatedUnit{Quantity::velocity, 0.0254};
  if (unit == "mil" || unit == "mils") return StatedUnit{Quantity::displacement, 2.54e-5};
  if (unit == "ug" || unit == "µg") return StatedUnit{Quantity::acceleration, 1e-6 * standard_gravity};
  if (unit == "gal" || unit == "Gal") return StatedUnit{Quantity::acceleration, 1e-2};
  if (unit == "m·s⁻²" || unit == "m s⁻²" || unit == "m·s-2") return StatedUnit{Quantity::acceleration, 1.0};
  static const std::set<std::string> microstrains{"microstrain", "µε", "με", "ue"};
  if (microstrains.contains(unit)) return StatedUnit{Quantity::strain, 1e-6};
  return stated_unit(unit);
}

// Units written as words, as oscilloscopes do.
bool is_seconds(std::string_view unit) {
  return folded(unit) == "second" || folded(unit) == "seconds";
}
bool is_volts(std::string_view unit) {
  return folded(unit) == "volt" || folded(unit) == "volts";
}

// Of a word, folded [s].
std::optional<double> unit_of_time(const std::string& word) {
  static const std::vector<std::pair<std::string_view, double>> units{
      {"s", 1.0},     {"sec", 1.0},        {"ms", 1e-3},     {"milli", 1e-3},
      {"us", 1e-6},   {"\xc2\xb5s", 1e-6}, {"micro", 1e-6},  {"ns", 1e-9},
      {"min", 60.0},  {"mins", 60.0},      {"minute", 60.0}, {"h", 3600.0},
      {"hr", 3600.0}, {"hrs", 3600.0},     {"hour", 3600.0}, {"std", 3600.0},
  };
  for (const auto* const list : {&units, &clocks})
    for (const auto& [symbol, seconds] : *list)
      if (word == symbol) return seconds;
  return {};
}

// Of words that name times, the one that is a unit of it: "time_min", "t_ms", "ms since start", "tUs".
std::optional<double> unit_among(const std::vector<std::string>& words) {
  static const std::set<std::string> began{"since", "from", "after"};
  if (words.size() == 1 && words[0].size() > 2 && words[0][0] == 't')
    return words[0] == "tns" || words[0] == "tmin" || words[0] == "tms" || words[0] == "tus"
               ? unit_of_time(words[0].substr(1))
               : std::nullopt;
  if (words.size() < 2 || (!any_word(words, times) && !any_word(words, began))) return {};
  std::optional<double> found;
  for (const std::string& word : words)
    if (const auto seconds = unit_of_time(word)) {
      if (found) return {};
      found = seconds;
    }
  return found;
}

std::string without_brackets(std::string text) {
  const bool both =
      (text.starts_with('[') && text.ends_with(']')) || (text.starts_with('(') && text.ends_with(')'));
  if (text.size() > 2 && both) text = text.substr(1, text.size() - 2);
  return text;
}

// The micro sign for a Greek mu, a point for a dot of mathematics, no signs of LaTeX, and units in Cyrillic
// letters, in brackets or behind a comma, in Latin ones.
std::string with_one_micro(std::string_view text) {
  static const std::vector<std::pair<std::string_view, std::string_view>> cyrillic{
      {"м/с2", "m/s2"},    {"м/с²", "m/s2"}, {"м/с^2", "m/s2"}, {"мм/с2", "mm/s2"}, {"мм/с²", "mm/s2"},
      {"мм/с^2", "mm/s2"}, {"м/с", "m/s"},   {"мм/с", "mm/s"},  {"мм", "mm"},       {"мкм", "um"},
      {"м", "m"},          {"см", "cm"},     {"с", "s"},        {"сек", "s"},       {"мс", "ms"},
      {"мкс", "us"},       {"мин", "min"},   {"Н", "N"},        {"кН", "kN"},       {"В", "V"},
      {"мВ", "mV"},        {"Гц", "Hz"},     {"м/с/с", "m/s2"}};
  std::string result(text);
  const std::size_t from =
                        result.find_last_of(",([") == std::string::npos ? 0 : result.find_last_of(",([") + 1,
                    end = std::min(result.find_first_of(")]", from), result.size());
  const std::string unit(trimmed(std::string_view(result).substr(from, end - from)));
  for (const auto& [written, latin] : cyrillic)
    if (unit == written)
      result.replace(from, end - from, (from > 0 && result[from - 1] == ',' ? " " : "") + std::string(latin));
  for (std::size_t at; (at = result.find("μ")) != std::string::npos;) result.replace(at, 2, "µ");
  for (std::size_t at; (at = result.find("⋅")) != std::string::npos;) result.replace(at, 3, "·");
  if (result.find('^') != std::string::npos)  // "$m/s^{2}$"
    std::erase_if(result, [](char c) { return c == '$' || c == '{' || c == '}'; });
  return result;
}

// A name and the unit that stands in or behind it.
std::pair<std::string, std::string> parted(std::string_view name) {
  name = trimmed(name.substr(0, name.find("(LGR S/N")));  // "X Accel, g (LGR S/N: 123)", of loggers of Onset
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}, std::pair{'<', '>'}}) {
    const std::size_t from = name.rfind(open), to = name.rfind(close);
    if (from != std::string_view::npos && to != std::string_view::npos && to > from)
      return {std::string(name.substr(0, from)) + std::string(name.substr(to + 1)),
              std::string(name.substr(from + 1, to - from - 1))};
  }
  for (std::size_t at = name.size(); at-- > 1;) {
    if (name[at] != '/' && name[at] != ',' && name[at] != '_' && name[at] != ' ' && name[at] != '-') continue;
    std::string_view unit = name.substr(at + 1);
    unit.remove_prefix(std::min(unit.find_first_not_of(' '), unit.size()));
    const bool slash_of_unit = name[at] == '/' && stated_unit(name.substr(name.find_last_of(",_ ", at) + 1));
    const auto of_acceleration = [&] {  // no letter of a channel, no north
      const auto found = unit_of(std::string(unit));
      return found && found->quantity == Quantity::acceleration &&
             (unit != "G" || quantity_of(words_of(name.substr(0, at)), name) == Quantity::acceleration);
    };
    const bool known = (name[at] != '-' && (stated_unit(unit) || unit == "ns" || unit == "dps" ||
                                            unit == "uT" || unit == "MS" || unit == "mS")) ||
                       of_acceleration();
    if (!unit.empty() && !slash_of_unit && known) return {std::string(name.substr(0, at)), std::string(unit)};
  }
  return {std::string(name), ""};
}

}  // namespace

std::optional<double> seconds_per_unit(std::string_view unit) {
  static const std::vector<std::pair<std::string_view, double>> more{
      {"ns", 1e-9}, {"min", 60.0}, {"h", 3600.0}, {"µs", 1e-6}, {"μs", 1e-6}};
  for (const auto& [symbol, seconds] : more)
    if (unit == symbol) return seconds;
  if (is_seconds(unit)) return 1.0;
  if (unit == "mS" || unit == "MS") return 1e-3;
  if (unit == "uS" || unit == "US") return 1e-6;
  const auto stated = stated_unit(unit);
  return stated && !stated->quantity ? std::optional(stated->factor) : std::nullopt;
}

bool is_other_unit(std::string_view unit) {
  return other_units.contains(std::string(unit));
}

namespace {

// Of UDUNITS: a word of a language, unless units that are certain stand beside it.
std::optional<StatedUnit> unit_elsewhere(const std::string& text) {
  if (unit_of(text) || other_units.contains(text) || is_volts(text)) return {};
  for (const Quantity quantity :
       {Quantity::acceleration, Quantity::velocity, Quantity::displacement, Quantity::force})
    if (const auto factor = convertible_unit(text, quantity)) return StatedUnit{quantity, *factor};
  return {};
}

// "accG", "a_mm_s2", "acc_cms2", "acc_ft_s2": of an acceleration, signs left out or no gap before it.
std::optional<double> unit_at_the_end(std::string_view name) {
  static const std::regex per_square(R"((?:^|[^A-Za-z])(mm|cm|m|ft|in)_?/?s_?\^?2(?:_[0-9])?$)"),
      gravity(R"((?:[a-z](m?G|mg)|_(m?g)_[0-9])$)");
  std::match_results<std::string_view::const_iterator> match;
  if (std::regex_search(name.begin(), name.end(), match, per_square))
    return convertible_unit(match[1].str() + "/s2", Quantity::acceleration);
  if (std::regex_search(name.begin(), name.end(), match, gravity))
    return unit_of(match[match[1].matched ? 1 : 2])->factor;
  return {};
}

// The factor of a unit that no table here has: of the column's own, or in brackets; else behind a slash, or
// behind a blank, a comma or an underscore where a sign shows that it is one ("velocity in/s", no "force
// in").
std::optional<double> factor_elsewhere(std::string_view name, std::string_view unit, Quantity quantity) {
  if (!unit.empty()) return convertible_unit(unit, quantity);
  const auto [plain, stated] = parted(name);
  if (!stated.empty() && name.find_first_of("[(") != std::string_view::npos)
    return convertible_unit(stated, quantity);
  const std::size_t slash = name.find('/'), gap = name.find_last_of(" ,_");
  if (slash != std::string_view::npos && slash > 0)
    if (const auto factor = convertible_unit(name.substr(slash + 1), quantity)) return factor;
  if (gap == std::string_view::npos || name.find_first_of("/^", gap) == std::string_view::npos) return {};
  return convertible_unit(name.substr(gap + 1), quantity);
}

}  // namespace

std::optional<RecognisedColumn> recognise_column(std::string_view written_name,
                                                 std::string_view written_unit) {
  const std::string name = with_one_micro(written_name.substr(0, 400)),  // regexes go no deeper
      unit = without_brackets(with_one_micro(written_unit));
  if (name.find("_per_") != std::string::npos &&  // of this project's own kind
      std::ranges::any_of(all_quantities, [&](Quantity one) { return name.starts_with(to_string(one)); }))
    return {};
  auto [plain, stated] = parted(name);
  if (!unit.empty()) stated = unit;
  const std::vector<std::string> words = words_of(plain);
  // Microseconds at 120 Hz at most; other instruments of the maker count 0.1 ms under this name.
  if (plain.find("SampleTimeFine") != std::string::npos)
    return RecognisedColumn{Kind::time, {}, 1e-6, true, true, "", 1e6 / 125.0};
  RecognisedColumn found;
  const auto is_time = [&](std::optional<double> seconds) {
    found.kind = Kind::time;
    found.factor = seconds.value_or(1.0);
    found.states_unit = seconds.has_value();
    return found;
  };
  if (is_seconds(unit)) return is_time(1.0);  // "Source" above "Second"
  for (const auto& [word, seconds] : clocks)
    if (any_word(words, {std::string(word)})) return is_time(seconds);
  if (const auto seconds = seconds_per_unit(stated);
      seconds && (words.empty() || (words.size() == 1 && words[0] == "in") ||
                  (static_cast<unsigned char>(plain[0]) & 0x80) != 0))
    return is_time(seconds);  // "[s]", "in s", and a word of other letters
  if (const auto seconds = seconds_per_unit(trimmed(name)); seconds && stated.empty())
    return is_time(seconds);
  if (const auto seconds = seconds_per_unit(stated);
      seconds && (begins(words[0], {"x"}) || any_word(words, counts)))
    return is_time(seconds);  // "X [s]", "sample_us"
  if (const auto seconds = unit_among(words); seconds && stated.empty()) return is_time(seconds);
  if (any_word(words, times) && !stated.empty() &&
      !seconds_per_unit(stated)) {  // "Zeit (Millisekunden)", "t [1/100 s]"
    const std::vector<std::string> inside = words_of(stated);
    const bool scaled = stated.find_first_of("0123456789") != std::string::npos;
    double seconds = 0.0;
    for (const std::string& word : inside) seconds = std::max(seconds, unit_of_time(word).value_or(0.0));
    if (seconds > 0.0 && inside.size() == 1 && !scaled) return is_time(seconds);
    if (seconds > 0.0 && scaled) return RecognisedColumn{Kind::time, {}, 0.0, true, true};
  }
  if (any_word(words, times) && any_word(words_of(stated), counts))
    return RecognisedColumn{Kind::count};  // "time (samples)"
  static const std::set<std::string> epochs{"unix", "epoch",    "utc", "gmt", "local",
                                            "abs",  "absolute", "hh",  "rel"};
  if (any_word(words, times) && any_word(words_of(stated), epochs)) return is_time({});
  if (const auto seconds = seconds_per_unit(stated); any_word(words, times) && (stated.empty() || seconds))
    return is_time(seconds);
  if (any_word(words, times) && !unit_of(stated))
    if (const auto seconds = convertible_unit(stated, {})) return is_time(seconds);  // "Time [hr]"
  static const std::regex of_quaternion("^[qQ][0-3wxyz]$");
  if (any_word(words, no_motion_at_all) || std::regex_match(plain, of_quaternion))
    return RecognisedColumn{Kind::other};
  const bool direction =  // "U(+)" is up
      (stated == "+" || stated == "-") && words.size() == 1 && words[0].size() == 1;
  const std::optional<Quantity> by_name = quantity_of(words, plain);
  const bool volts = readings.contains(stated) || stated == "kV";
  const bool is_voltage = volts && by_name == Quantity::displacement && words.front() == "u",
             named = by_name.has_value() && !is_voltage && !direction;
  if (!named && std::ranges::any_of(words, [](const auto& word) {
        return begins(word, {"freq", "frecuen"});
      }))
    return RecognisedColumn{Kind::frequency};
  if (!named && (any_word(words, no_motion) || seconds_per_unit(stated)))
    return RecognisedColumn{Kind::other};
  if (!named && (stated.empty() || stated == "#" || stated == "-") && any_word(words, counts) &&
      (words.size() == 1 || words.front().size() > 1))
    return RecognisedColumn{Kind::count};
  if (is_volts(stated)) stated = "V";
  static const std::regex range_of_sensor("[0-9]+ ?g");  // "X (100g)"
  if (std::regex_match(stated, range_of_sensor)) stated = "g";
  auto known = unit_of(stated);
  if (!known && !named && !unit.empty()) known = unit_elsewhere(unit);
  if (readings.contains(stated)) found.reading = stated;
  if (!named && !stated.empty() &&
      (stated.find("deg") != std::string::npos || stated.find("rad") != std::string::npos ||
       stated.find("°") != std::string::npos || (other_units.contains(stated) && !readings.contains(stated))))
    return RecognisedColumn{Kind::other};
  found.states_quantity = named || (known && known->quantity);
  found.quantity = Quantity::acceleration;
  if (known && known->quantity) found.quantity = *known->quantity;
  const bool letter_alone =  // "v [mm]": a unit says more
      words.size() == 1 && words[0].size() == 1 && known && known->quantity && !direction;
  if (named && !letter_alone) found.quantity = by_name.value_or(found.quantity);
  const Quantity in_units_of =
      found.quantity == Quantity::base_acceleration ? Quantity::acceleration : found.quantity;
  if (known && known->quantity == in_units_of) {
    found.factor = known->factor;
    found.states_unit = true;
  } else if (any_word(words, {"gfx", "gfy", "gfz"})) {
    found.factor = standard_gravity;
    found.states_unit = true;
  } else if (const auto last = unit_at_the_end(name);
             last && named && in_units_of == Quantity::acceleration) {
    found.factor = *last;
    found.states_unit = true;
  } else if (const auto factor = named ? factor_elsewhere(name, unit, in_units_of) : std::nullopt) {
    found.factor = *factor;
    found.states_unit = true;
  }
  return found;
}

bool are_units(const std::vector<std::string_view>& fields) {
  bool any = false;
  for (const std::string_view field : fields) {
    const std::string text = without_brackets(unquoted(field));
    if (text.empty() || text == "-") continue;
    const bool is_certain =
        unit_of(text) || seconds_per_unit(text) || other_units.contains(text) || is_volts(text);
    if (!is_certain && !unit_elsewhere(text)) return false;
    any = any || is_certain;
  }
  return any;
}

bool names_columns(const std::vector<std::string_view>& fields) {
  static const std::regex direction(
      "[nsew][0-9]{0,3}[nsew]?|n-s|e-w|u-d|ud|up|v|x|y|z|north|south|east|west|vertical");
  bool named = fields.size() > 1 && std::ranges::all_of(fields, [](std::string_view field) {
                 return std::regex_match(folded(unquoted(field)), direction);
               });
  for (const std::string_view field : fields) {
    const std::string text(unquoted(field)), bare = without_brackets(text);
    if (unit_of(text) || seconds_per_unit(text) || other_units.contains(text)) return false;
    if (bare != text && (unit_of(bare) || convertible_unit(bare, Quantity::acceleration)))
      return false;  // the last word of a title
    const auto found = recognise_column(text, "");
    named = named || !found || found->states_quantity || found->kind == RecognisedColumn::Kind::time;
  }
  return named;
}

}  // namespace beamid::experiments
