// Units of any spelling, through UDUNITS-2 [udunits].
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
#include "experiments/record/units.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/input_error.hpp"

namespace beamid::experiments {
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

}  // namespace beamid::experiments
