// The signals of a binary file, made one table.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "experiments/record/read_apart.hpp"
#include "experiments/record/recognised_column.hpp"
#include "experiments/record/record.hpp"
#include "experiments/record/record_columns.hpp"
#include "experiments/record/stamps.hpp"
#include "experiments/record/units.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {
namespace {

/// "data.time" -> "time".
std::string last_part(const std::string& name) {
  const std::size_t at = name.find_last_of("./");
  return at == std::string::npos ? name : name.substr(at + 1);
}

/// What a name says of times: "t" and "time" nothing, "time_ms" the unit.
struct TimeName {
  bool time = false;
  std::string unit;
};

TimeName time_name(const std::string& name) {
  const std::string last = last_part(name);
  if (last == "t" || last == "time" || last == "Time") return {true, ""};
  for (const Unit& unit : time_units())
    if (last == "time_" + unit.suffix || last == "t_" + unit.suffix) return {true, unit.symbol};
  return {};
}

/// "bearing.sr" -> "bearing.": the group, struct or variable in which a name stands.
std::string scope_of(const std::string& name) {
  return name.substr(0, name.size() - last_part(name).size());
}

/// Whether a signal stands in a scope, or is the variable whose attributes the scope holds.
bool is_within(const std::string& signal, const std::string& scope) {
  if (signal.starts_with(scope)) return true;
  return scope.size() > 1 && signal.starts_with(scope.substr(0, scope.size() - 1)) &&
         (signal.size() + 1 == scope.size() || signal[scope.size() - 1] == '[' ||
          signal[scope.size() - 1] == '(');
}

/// Which signals a text named so states the unit of.
enum class UnitOf { none, all, times, sibling, channel };

UnitOf unit_of_what(const std::string& name, std::string* of_which = nullptr) {
  static const std::regex all(
      "(?:y|data|signals?|channels?|amplitude|values?|measurement|measured|physical)?_?"
      "(?:units?|einheit(?:en)?|unites?|unidad(?:es)?|unita)(?:_?(?:string|name|label|symbol|y))?"),
      times("(?:time|t|x)_?units?|units?_(?:time|t|x)"), sibling("(.+?)_?units?|units?_(.+)"),
      channel(R"((?:channel_?|y_?)?units?\{([0-9]+)\})");
  std::smatch match;
  const std::string last = folded(last_part(name));
  if (std::regex_match(last, times)) return UnitOf::times;
  if (std::regex_match(last, all)) return UnitOf::all;
  const UnitOf found = std::regex_match(last, match, channel)   ? UnitOf::channel
                       : std::regex_match(last, match, sibling) ? UnitOf::sibling
                                                                : UnitOf::none;
  if (found != UnitOf::none && of_which) *of_which = match[match[1].length() > 0 ? 1 : 2];
  return found;
}

}  // namespace

void CollectedSignals::announce(const std::string& name, const std::vector<std::size_t>& extent) {
  double count = 1.0;
  for (const std::size_t size : extent) count *= static_cast<double>(size);
  announced_ += count;
  if (announced_ > static_cast<double>(most_numbers_))
    throw InputError(
        {file_}, fmt::format("'{}' claims {} numbers, {:.3g} with those before it; expected at most "
                             "{:.3g} in all, which a file of this size can hold",
                             name, fmt::join(extent, " x "), announced_, static_cast<double>(most_numbers_)));
}

void CollectedSignals::add(std::string name, std::string unit, std::vector<double> values, int digits) {
  if (values.size() > 1) add_numbers(std::move(name), std::move(unit), std::move(values), digits);
}

void CollectedSignals::add_numbers(std::string name, std::string unit, std::vector<double> values,
                                   int digits) {
  for (double& value : values)
    if (!std::isfinite(value)) value = std::nan("");
  signals_.push_back({std::move(name), std::move(unit), std::move(values), digits});
}

void CollectedSignals::add_matrix(const std::function<std::string(std::size_t, bool)>& name_of,
                                  const std::string& unit, const std::vector<double>& values,
                                  std::size_t rows, std::size_t columns, int digits) {
  constexpr std::size_t most_signals = 4096;
  const bool by_rows = rows < columns;
  const std::size_t count = std::min(rows, columns), length = std::max(rows, columns);
  if (count > most_signals)
    throw InputError({file_}, fmt::format("{} is {} x {}; expected at most {} channels", name_of(1, by_rows),
                                          rows, columns, most_signals));
  for (std::size_t k = 0; k < count; ++k) {
    std::vector<double> signal(length);
    for (std::size_t i = 0; i < length; ++i)
      signal[i] = by_rows ? values[k + i * rows] : values[i + k * rows];
    add(name_of(k + 1, by_rows), unit, std::move(signal), digits);
  }
}

void CollectedSignals::add_variable(const std::string& name, std::vector<double> values, std::size_t rows,
                                    std::size_t columns, int digits) {
  const auto name_of = [&](std::size_t k, bool is_row) {
    return is_row ? fmt::format("{}({},:)", name, k) : fmt::format("{}(:,{})", name, k);
  };
  if (rows == 1 || columns == 1)
    add(name, "", std::move(values), digits);
  else
    add_matrix(name_of, "", values, rows, columns, digits);
}

bool CollectedSignals::set(const std::string& name, double value) {
  const std::string last = last_part(name);
  const SamplingName what = sampling_name(last);
  if (what == SamplingName::none) return false;
  if (!(value > 0 && std::isfinite(value)))
    throw InputError({file_}, fmt::format("{} is {}; expected a positive number", name, value));
  const double stated = what == SamplingName::rate ? 1 / value : value;
  constexpr double longest = 0.5;  // [s]; more is one of milliseconds
  if (what == SamplingName::interval && stated > longest) return true;
  set_interval(name, stated);
  return true;
}

void CollectedSignals::add_text(const std::string& name, const std::string& text) {
  constexpr std::size_t longest = 64;
  const std::string_view stated = trimmed(text);
  if (stated.empty() || stated.size() > longest) return;
  if (const SamplingName what = sampling_name(last_part(name)); what != SamplingName::none) {
    const auto rate = stated_rate(fmt::format("{} = {}", what == SamplingName::rate ? "fs" : "dt", stated));
    if (rate) set_interval(name, 1.0 / *rate);
  } else if (unit_of_what(name) != UnitOf::none) {
    add_statement({name, 0.0, std::string(stated)});
  }
}

namespace {

/// "rate" may be that of a shaft, and any other name is more certain.
bool is_vague(const std::string& name) {
  return folded(last_part(name)) == "rate";
}

}  // namespace

// Of the innermost scope around the signal. @throws InputError where two there differ, if `asked`
const CollectedSignals::Statement* CollectedSignals::interval_for(const std::string& signal,
                                                                  bool asked) const {
  constexpr double alike = 1e-9;
  for (const bool vague : {false, true}) {
    const Statement* found = nullptr;
    for (const Statement& one : statements_) {
      if (!(one.interval > 0.0) || is_vague(one.name) != vague || !is_within(signal, scope_of(one.name)))
        continue;
      const std::size_t depth = scope_of(one.name).size(), before = found ? scope_of(found->name).size() : 0;
      if (asked && found && depth == before &&
          std::abs(one.interval - found->interval) > alike * one.interval)
        throw InputError({file_},
                         fmt::format("{} means an interval of {:.6g} s beside one of {:.6g} s by {}; "
                                     "expected one, or the sampling rate: --rate HZ",
                                     one.name, one.interval, found->interval, found->name));
      if (!found || depth > before) found = &one;
    }
    if (found) return found;
  }
  return nullptr;
}

// That of all signals of the table; where none stands in the scope of a statement, that of all statements.
const CollectedSignals::Statement* CollectedSignals::interval_of(const RecordTable& table, bool asked) const {
  constexpr double alike = 1e-9;
  const Statement* found = nullptr;
  const auto take = [&](const Statement* one, const std::string& name) {
    if (asked && one && found && std::abs(one->interval - found->interval) > alike * found->interval)
      throw InputError({file_}, fmt::format("{} means an interval of {:.6g} s{}, and {} one of {:.6g} s; "
                                            "expected one, or the channels of one rate: --rate HZ --column N",
                                            one->name, one->interval, name.empty() ? "" : " for " + name,
                                            found->name, found->interval));
    if (one && !found) found = one;
  };
  for (const std::string& name : table.names)
    if (!time_name(name).time) take(interval_for(name, asked), name);
  if (found) return found;
  for (const bool vague : {false, true})
    for (const Statement& one : statements_)
      if (one.interval > 0.0 && is_vague(one.name) == vague && (!found || is_vague(found->name) == vague))
        take(&one, "");
  return found;
}

// A text that names the signal, or the nearest of those for all; a signal of another quantity has none.
std::string CollectedSignals::unit_for(const Signal& signal) const {
  const std::string last = last_part(signal.name);
  const std::size_t bracket = last.find_first_of("([{");
  const std::string own = folded(last.substr(0, bracket));
  if (own == "gs") return "g";  // of the bearings of MFPT
  const bool time = time_name(signal.name).time;
  std::string unit;
  std::size_t depth = 0;
  bool several = false;
  for (const Statement& one : statements_) {
    const std::string scope = scope_of(one.name);
    if (one.unit.empty() || !is_within(signal.name, scope)) continue;
    std::string which;
    const UnitOf what = unit_of_what(one.name, &which);
    if (what == UnitOf::sibling && which == own) return one.unit;
    if (what == UnitOf::channel &&
        (last.ends_with("(:," + which + ")") || last.ends_with("(" + which + ",:)")))
      return one.unit;
    if (what != (time ? UnitOf::times : UnitOf::all)) continue;
    several = scope.size() == depth && !unit.empty() ? several || unit != one.unit
              : scope.size() > depth                 ? false
                                                     : several;
    if (unit.empty() || scope.size() > depth) unit = one.unit, depth = scope.size();
  }
  if (several) return "";
  if (time) return unit;
  const auto named = recognise_column(last, ""), measured = recognise_column(last, unit);
  const bool other = named && (named->kind != RecognisedColumn::Kind::signal ||
                               (named->states_quantity && measured && !measured->states_unit));
  return other ? "" : unit;
}

void CollectedSignals::find_time(RecordTable& table, const RecordFormat& format) const {
  const Statement* const stated = interval_of(table, !format.time && !format.sampling_rate);
  auto at = std::find_if(table.names.begin(), table.names.end(),
                         [](const std::string& name) { return time_name(name).time; });
  for (std::size_t k = 0; k < table.width() && at == table.names.end(); ++k)
    if (table.units[k] != "h" && unit_of_times(table.units[k]) && rises(table.columns[k]))
      at = table.names.begin() + static_cast<std::ptrdiff_t>(k);
  if (at == table.names.end()) {
    if (stated) table.clock = {0.0, stated->interval};
    return;
  }
  const auto column = static_cast<std::size_t>(at - table.names.begin());
  const std::string named = time_name(*at).unit;
  std::string& unit = table.units[column];
  if (unit.empty()) unit = named;
  const auto factor = seconds_per(unit, "'" + *at + "'", file_, format);
  if (!factor) return;
  if (!named.empty() && *factor != *seconds_per(named, *at, file_, format))
    throw InputError({file_}, fmt::format("'{}' is in '{}'; expected the unit of its name", *at, unit));
  if (unit.empty() && !format.time && !format.sampling_rate) {
    const double by_size = seconds_of_epoch(table.columns[column]);  // since 1970, in ns or the like
    if (by_size != 1.0) {
      for (double& time : table.columns[column]) time *= by_size;
      unit = "s";
      table.remarks.push_back(
          fmt::format("'{}' is taken as time in {}, by its size.", *at, symbol_of_time(by_size)));
    } else if (!stated) {
      require_plausible_step(table, column, 1.0);
    }
  }
  if (!stated_unit(unit) && !unit.empty() && !format.time) {  // ns, minutes, "seconds since 1970-01-01"
    for (double& time : table.columns[column]) time *= *factor;
    unit = "s";
  }
  const double to_seconds = unit == "s" ? 1.0 : *factor;
  if (to_seconds == 1.0) table.time = column;  // else found by its unit
  const std::vector<double>& times = table.columns[column];
  const double mean = to_seconds * (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  constexpr double tolerated = 0.02;
  if (stated && !format.time && !format.sampling_rate &&
      std::abs(mean - stated->interval) > tolerated * stated->interval)
    throw InputError(
        {file_},
        fmt::format("{} means an interval of {:.6g} s, and '{}' has one of {:.6g} s; expected them to "
                    "agree, or record.time or record.sampling_rate_hz in the configuration",
                    stated->name, stated->interval, *at, mean));
}

std::size_t length_of_most_numbers(const std::vector<std::size_t>& lengths) {
  std::map<std::size_t, std::size_t> numbers;  // of each length
  for (const std::size_t length : lengths) numbers[length] += length;
  return numbers.empty()
             ? 0
             : std::ranges::max_element(numbers, {}, [](const auto& one) { return one.second; })->first;
}

std::size_t CollectedSignals::common_length() const {
  if (signals_.empty())
    throw InputError({file_},
                     "no signal of at least two numbers; expected vectors or matrices of real numbers");
  std::vector<std::size_t> lengths;
  for (const Signal& signal : signals_) lengths.push_back(signal.values.size());
  return length_of_most_numbers(lengths);
}

RecordTable CollectedSignals::table(const RecordFormat& format) const {
  const std::size_t length = common_length();
  RecordTable table;
  table.file = file_;
  std::string others;
  for (const Signal& signal : signals_) {
    if (signal.values.size() != length) {
      others += fmt::format("{}{} ({})", others.empty() ? "" : ", ", signal.name, signal.values.size());
      continue;
    }
    table.names.push_back(signal.name);
    table.units.push_back(signal.unit.empty() ? unit_for(signal) : signal.unit);
    table.columns.push_back(signal.values);
    table.precision.push_back(PrintedPrecision::of_digits(signal.digits));
  }
  find_time(table, format);
  table.by_people = true;
  const bool bare_times = table.time && !format.time && table.units[*table.time].empty();
  for (std::size_t i = 0; i < table.width(); ++i) {
    const auto meaning = parse_column_name(table.names[i]);
    const auto unit = stated_unit(table.units[i]);
    if ((meaning && meaning->quantity) || (unit && unit->quantity)) table.by_people = false;
  }
  if (table.by_people && bare_times) table.time.reset();  // recognised as those of a text
  if (bare_times && !table.by_people)
    table.remarks.push_back(
        fmt::format("'{}' states no unit: its times are taken as seconds.", table.names[*table.time]));
  const auto stated = [&](std::size_t i) { return table.time != i && !table.units[i].empty(); };
  bool units = false;
  for (std::size_t i = 0; i < table.width(); ++i) units = units || stated(i);
  if (!units) table.units.clear();
  if (!others.empty())
    table.remarks.push_back(fmt::format("Omitted, as not of {} samples: {}.", length, others));
  return table;
}

}  // namespace beamid::experiments
