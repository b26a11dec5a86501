#include "experiments/record/units.hpp"

#include <fmt/format.h>
#include <udunits2.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>

#include <needed_library.hpp>
#include "experiments/text/fields.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

/// @param start "acceleration"; @param known its units.
std::optional<ColumnMeaning> parse_as(std::string_view name, std::string_view start,
                                      const std::vector<Unit>& known) {
  if (!name.starts_with(start)) return std::nullopt;
  name.remove_prefix(start.size());
  for (const Unit& unit : known) {
    const std::string end = "_" + unit.suffix;
    if (!name.ends_with(end)) continue;
    name.remove_suffix(end.size());
    if (!name.empty() && (name.front() != '_' || name.size() == 1)) return std::nullopt;
    return ColumnMeaning{std::nullopt, std::string(name.empty() ? name : name.substr(1)), unit.factor};
  }
  return std::nullopt;
}

/// The channel's name as a label: "Tip acceleration, x" -> "tip_x".
std::string label(const Channel& channel) {
  if (const auto meaning = parse_column_name(channel.name)) return meaning->label;
  std::string words;
  for (const char letter : channel.name) {
    const bool lower = letter >= 'a' && letter <= 'z', upper = letter >= 'A' && letter <= 'Z';
    const bool digit = letter >= '0' && letter <= '9';
    if (lower || upper || digit)
      words += upper ? static_cast<char>(letter - 'A' + 'a') : letter;
    else if (!words.empty() && words.back() != '_')
      words += '_';
  }
  const std::string quantity = to_string(channel.quantity);
  if (const std::size_t at = words.find(quantity); at != std::string::npos) words.erase(at, quantity.size());
  words.erase(std::unique(words.begin(), words.end(), [](char a, char b) { return a == '_' && b == '_'; }),
              words.end());
  if (!words.empty() && words.front() == '_') words.erase(0, 1);
  if (!words.empty() && words.back() == '_') words.pop_back();
  return words;
}

}  // namespace

std::optional<ColumnMeaning> parse_column_name(std::string_view name) {
  for (const char* start : {"time", "t"})
    if (auto time = parse_as(name, start, time_units()); time && time->label.empty()) return time;
  for (const Quantity quantity : all_quantities)
    if (auto meaning = parse_as(name, to_string(quantity), units(quantity))) {
      meaning->quantity = quantity;
      return meaning;
    }
  return std::nullopt;
}

std::vector<std::string> column_names(const Record& record) {
  std::vector<std::string> names{"time_s"};
  for (const Channel& channel : record.channels) {
    const std::string middle = label(channel), start = to_string(channel.quantity);
    const std::string end = "_" + units(channel.quantity).front().suffix;
    std::string name = start + (middle.empty() ? "" : "_" + middle) + end;
    for (int copy = 2; std::find(names.begin(), names.end(), name) != names.end(); ++copy)
      name = start + (middle.empty() ? "" : "_" + middle) + "_" + std::to_string(copy) + end;
    names.push_back(std::move(name));
  }
  return names;
}

std::string quantity_key(Quantity quantity) {
  return std::string(to_string(quantity)) + "_" + units(quantity).front().suffix;
}

std::string known_column_names() {
  std::vector<std::string> names;
  for (const Unit& unit : time_units()) names.push_back("time_" + unit.suffix);
  for (const Quantity quantity : all_quantities)
    for (const Unit& unit : units(quantity))
      names.push_back(std::string(to_string(quantity)) + "_" + unit.suffix);
  return joined(names);
}

const std::vector<Unit>& units(Quantity quantity) {
  static const std::vector<Unit> displacement{{"m", "m", 1}, {"mm", "mm", 1e-3}, {"um", "um", 1e-6}};
  static const std::vector<Unit> velocity{{"m/s", "m_per_s", 1}, {"mm/s", "mm_per_s", 1e-3}};
  static const std::vector<Unit> acceleration{
      {"m/s2", "m_per_s2", 1}, {"mm/s2", "mm_per_s2", 1e-3}, {"g", "g", standard_gravity}};
  static const std::vector<Unit> force{{"N", "n", 1}, {"kN", "kn", 1e3}};
  static const std::vector<Unit> strain{{"m/m", "m_per_m", 1}, {"um/m", "um_per_m", 1e-6}};
  static const std::vector<Unit> angular{{"rad/s2", "rad_per_s2", 1}, {"mrad/s2", "mrad_per_s2", 1e-3}};
  switch (quantity) {
    case Quantity::displacement:
      return displacement;
    case Quantity::velocity:
      return velocity;
    case Quantity::acceleration:
    case Quantity::base_acceleration:
    case Quantity::support_acceleration:
      return acceleration;
    case Quantity::strain:
      return strain;
    case Quantity::angular_acceleration:
    case Quantity::support_angular_acceleration:
      return angular;
    case Quantity::force:
      break;
  }
  return force;
}

const std::vector<Unit>& time_units() {
  static const std::vector<Unit> time{{"s", "s", 1}, {"ms", "ms", 1e-3}, {"us", "us", 1e-6}};
  return time;
}

std::optional<Quantity> find_quantity(std::string_view name) {
  const auto* const quantity = std::find_if(std::begin(all_quantities), std::end(all_quantities),
                                            [&](Quantity q) { return to_string(q) == name; });
  return quantity == std::end(all_quantities) ? std::nullopt : std::optional(*quantity);
}

namespace {

/// Without brackets, blanks, '^', '*' and a raised two.
std::string plain(std::string_view spelling) {
  std::string text(spelling);
  for (const std::string_view raised : {"\u00b2", "\xb2"})
    for (std::size_t at; (at = text.find(raised)) != std::string::npos;) text.replace(at, raised.size(), "2");
  for (const std::string_view micro : {"\u00b5", "\u03bc", "\xb5"})
    for (std::size_t at; (at = text.find(micro)) != std::string::npos;) text.replace(at, micro.size(), "u");
  text.erase(std::remove_if(text.begin(), text.end(),
                            [](char c) {
                              return c == ' ' || c == '[' || c == ']' || c == '(' || c == ')' || c == '^' ||
                                     c == '*';
                            }),
             text.end());
  return text;
}

}  // namespace

std::optional<StatedUnit> stated_unit(std::string_view spelling) {
  static const std::map<std::string, std::string> others{
      {"m/sec2", "m/s2"}, {"m/s/s", "m/s2"}, {"mm/sec2", "mm/s2"}, {"m/sec", "m/s"},
      {"mm/sec", "mm/s"}, {"newton", "N"},   {"Newton", "N"},      {"Newtons", "N"},
      {"meter", "m"},     {"metre", "m"},    {"Meter", "m"},       {"gn", "g"},
      {"sec", "s"},       {"Sec", "s"},      {"second", "s"},      {"seconds", "s"},
      {"Seconds", "s"},   {"msec", "ms"},    {"ustrain", "um/m"},  {"microstrain", "um/m"},
      {"ue", "um/m"},     {"strain", "m/m"}, {"ms-2", "m/s2"},     {"ms-1", "m/s"}};
  std::string symbol = plain(spelling);
  if (const auto other = others.find(symbol); other != others.end()) symbol = other->second;
  for (const Unit& unit : time_units())
    if (unit.symbol == symbol) return StatedUnit{std::nullopt, unit.factor};
  for (const Quantity quantity : all_quantities)
    for (const Unit& unit : units(quantity))
      if (unit.symbol == symbol || unit.suffix == symbol) return StatedUnit{quantity, unit.factor};
  return std::nullopt;
}

std::vector<std::string> symbols(const std::vector<Unit>& units) {
  std::vector<std::string> result;
  for (const Unit& unit : units) result.push_back(unit.symbol);
  return result;
}

std::optional<double> unit_factor(std::string_view symbol, std::optional<Quantity> quantity) {
  for (const Unit& unit : quantity ? units(*quantity) : time_units())
    if (unit.symbol == symbol) return unit.factor;
  return convertible_unit(symbol, quantity);
}

// Units of any spelling, through UDUNITS-2 [udunits].

namespace {

// Which spellings are looked up. UDUNITS-2 has some hundred words, each with any prefix and each as a
// factor of a product: "rod" is 5.03 m, "kin" a thousand inches, "N1" a newton and "3 m" three metres.

/// Of a quantity: its SI unit, and factors that records of it have. A unit outside is a slip of the keyboard
/// ("Mm" for "mm"), or something else ("au" for arbitrary units, "fs" for a rate).
struct QuantityUnit {
  const char* si;
  double smallest, largest;
};

QuantityUnit unit_of_quantity(std::optional<Quantity> quantity) {
  if (!quantity) return {"s", 1e-12, 7e5};
  switch (*quantity) {
    case Quantity::displacement:
      return {"m", 1e-11, 1e3};
    case Quantity::velocity:
      return {"m/s", 1e-11, 1e3};
    case Quantity::acceleration:
    case Quantity::base_acceleration:
    case Quantity::support_acceleration:
      return {"m/s2", 1e-10, 1e3};
    case Quantity::strain:
      return {"1", 1e-12, 1.0};
    case Quantity::angular_acceleration:
    case Quantity::support_angular_acceleration:
      return {"rad/s2", 1e-10, 1e3};
    case Quantity::force:
      break;
  }
  return {"N", 1e-9, 1e9};
}

/// Words that stand in brackets for places, axes and kinds of signals, and units of time that no clock has.
const std::set<std::string, std::less<>> other_words{
    "rod",   "pole",    "perch", "chain",        "foot",      "yard",
    "pica",  "pond",    "force", "gravity",      "gp",        "shake",
    "jiffy", "dynamic", "fermi", "geopotential", "arpentlin", "standard_free_fall"};

/// "kin", "dft": a prefix before a unit that has none, but for microinches.
bool is_odd_multiple(std::string_view word) {
  if (word == "uin" || word == "\u00b5in" || word == "\u03bcin" || word == "min" || word == "mil")
    return false;
  for (const std::string_view unit : {"in", "ft", "yd", "mi", "mil"})
    if (word.size() > unit.size() && word.size() <= unit.size() + 2 && word.ends_with(unit)) return true;
  return word == "hs" || word == "ks" || word == "das";
}

/// Letters with signs of products, quotients and powers between them. A digit is an exponent, 2 to 4 or
/// negative, so that no number hides in the unit.
bool is_written_as_unit(std::string_view text) {
  constexpr std::size_t longest = 32;
  if (text.empty() || text.size() > longest) return false;
  const auto is = [](char c, int (*what)(int)) { return what(static_cast<unsigned char>(c)) != 0; };
  bool letters = false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k], before = k > 0 ? text[k - 1] : ' ',
               after = k + 1 < text.size() ? text[k + 1] : ' ';
    const bool letter = is(c, std::isalpha) || (c & 0x80) != 0;
    letters = letters || letter || c == '%';
    if (is(c, std::isdigit)) {
      const bool behind = is(before, std::isalpha) || before == '^' || before == '-';
      if (!behind || is(after, std::isalnum) || c > '4' || c == '0' || (c == '1' && before != '-'))
        return false;
    } else if (c == '-') {
      if (!(is(before, std::isalpha) || before == '^') || !is(after, std::isdigit)) return false;
    } else if (!letter && std::string_view("/^*. _%").find(c) == std::string_view::npos) {
      return false;
    }
  }
  return letters;
}

// The library, loaded when the first spelling is asked for: its table of units is read once.

constexpr NeededLibrary udunits{"libudunits2.so.0", "libudunits2-0"};
BEAMID_NEEDED(udunits, ut_set_error_message_handler);
BEAMID_NEEDED(udunits, ut_ignore);
BEAMID_NEEDED(udunits, ut_read_xml);
BEAMID_NEEDED(udunits, ut_parse);
BEAMID_NEEDED(udunits, ut_free);
BEAMID_NEEDED(udunits, ut_are_convertible);
BEAMID_NEEDED(udunits, ut_get_converter);
BEAMID_NEEDED(udunits, cv_convert_double);
BEAMID_NEEDED(udunits, cv_free);

class UnitSystem {
 public:
  /// @throws std::runtime_error without the library.
  UnitSystem() {
    ut_set_error_message_handler(ut_ignore);
    system_ = ut_read_xml(nullptr);
  }

  /// Of a linear conversion, to the digits that its definition states: products such as 2.54 * 0.01 are
  /// rounded. Reciprocal units (Hz of s), logarithms and offsets have none.
  std::optional<double> factor(const std::string& from, const char* to) const {
    if (system_ == nullptr) return {};
    ut_unit *const unit = ut_parse(system_, from.c_str(), UT_UTF8), *const si =
                                                                        ut_parse(system_, to, UT_UTF8);
    std::optional<double> found;
    if (unit != nullptr && si != nullptr && ut_are_convertible(unit, si) != 0)
      if (cv_converter* const converter = ut_get_converter(unit, si)) {
        const double one = cv_convert_double(converter, 1.0);
        if (cv_convert_double(converter, 0.0) == 0.0 && one > 0.0 && std::isfinite(one) &&
            std::abs(cv_convert_double(converter, -2.0) + 2.0 * one) <= 1e-14 * one)
          found = without_rounding_of_products(one);
        cv_free(converter);
      }
    if (unit != nullptr) ut_free(unit);
    if (si != nullptr) ut_free(si);
    return found;
  }

 private:
  static double without_rounding_of_products(double factor) {
    constexpr double few_roundings = 6e-16;
    const double decimal = std::strtod(fmt::format("{:.14g}", factor).c_str(), nullptr);
    return std::abs(decimal - factor) <= few_roundings * factor ? decimal : factor;
  }

  ut_system* system_ = nullptr;
};

/// The library parses one text at a time, for whatever thread.
std::optional<double> factor_by_udunits(const std::string& from, const char* to) {
  static std::mutex one_at_a_time;
  static std::map<std::pair<std::string, std::string>, std::optional<double>> known;
  const std::lock_guard lock(one_at_a_time);
  const auto [at, added] = known.try_emplace({from, to});
  if (!added) return at->second;
  static const std::optional<UnitSystem> system = []() -> std::optional<UnitSystem> {
    try {
      return std::optional<UnitSystem>(std::in_place);
    } catch (const std::runtime_error&) {  // no such library: the own table is all there is
      return std::nullopt;
    }
  }();
  return at->second = system ? system->factor(from, to) : std::nullopt;
}

}  // namespace

std::optional<double> convertible_unit(std::string_view spelling, std::optional<Quantity> quantity) {
  std::string unit = clean_text(trimmed(spelling));
  if (unit.size() > 2 &&
      ((unit.front() == '[' && unit.back() == ']') || (unit.front() == '(' && unit.back() == ')')))
    unit = trimmed(std::string_view(unit).substr(1, unit.size() - 2));
  for (std::size_t at; (at = unit.find("**")) != std::string::npos;) unit.replace(at, 2, "^");
  if (!is_written_as_unit(unit) || other_words.contains(unit) || is_odd_multiple(unit)) return {};
  const QuantityUnit wanted = unit_of_quantity(quantity);
  if (quantity == Quantity::strain) {  // no ratio of others, such as mV/V
    const std::size_t slash = unit.find('/');
    const bool lengths = slash != std::string::npos && factor_by_udunits(unit.substr(0, slash), "m") &&
                         factor_by_udunits(unit.substr(slash + 1), "m");
    if (!lengths && unit != "%" && unit != "percent" && unit != "ppm") return {};
  }
  const bool angular =
      quantity == Quantity::angular_acceleration || quantity == Quantity::support_angular_acceleration;
  if (angular && unit.find("rad") == std::string::npos && unit.find("deg") == std::string::npos &&
      unit.find("\u00b0") == std::string::npos)
    return {};  // an angle has no dimension: 1/s2 would do
  const auto factor = factor_by_udunits(unit, wanted.si);
  return factor && *factor >= wanted.smallest && *factor <= wanted.largest ? factor : std::nullopt;
}

std::optional<double> unit_of_times(std::string_view written) {
  const std::string_view unit = trimmed(written.substr(0, written.find(" since ")));
  if (const auto stated = stated_unit(unit))
    return stated->quantity ? std::nullopt : std::optional(stated->factor);
  for (const auto& [word, seconds] : {std::pair{"ns", 1e-9}, {"min", 60.0}, {"mins", 60.0}, {"h", 3600.0}})
    if (unit == word) return seconds;
  return unit.empty() ? std::nullopt : convertible_unit(unit, {});
}

std::string symbol_of_time(double factor) {
  return factor == 1.0       ? "s"
         : factor == 1e-3    ? "ms"
         : factor == 1e-6    ? "us"
         : factor == 1e-9    ? "ns"
         : factor == 1e-7    ? "100 ns"
         : factor == 60.0    ? "min"
         : factor == 3600.0  ? "h"
         : factor == 86400.0 ? "days"
                             : fmt::format("{:g} s", factor);
}

}  // namespace beamid::experiments
