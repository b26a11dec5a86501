// The signals of a binary file, made one table.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "experiments/record/read_apart.hpp"
#include "experiments/record/recognised_column.hpp"
#include "experiments/record/record.hpp"
#include "experiments/record/units.hpp"

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

void CollectedSignals::set_text(const std::string& name, const std::string& text) {
  const std::string last = folded(last_part(name));
  if (!stated_unit(text)) return;
  const std::string path = name.substr(0, name.size() - last.size());
  if (last == "unit" || last == "units")
    unit_texts_.emplace_back(path, text);
  else if (const std::size_t end = last.rfind("_unit"); end != std::string::npos && end + 6 >= last.size())
    unit_texts_.emplace_back(name.substr(0, path.size() + end), text);
}

void CollectedSignals::take_units() {
  for (const auto& [of, unit] : unit_texts_) {
    const bool is_path = of.empty() || of.ends_with('.');
    const auto variable = [](const std::string& name) {
      return name.substr(0, name.find('(', name.rfind('.') + 1));
    };
    std::set<std::string> variables;
    const auto belongs = [&](const Signal& signal) {
      const std::string own = variable(signal.name);
      return !time_name(own).time &&
             (is_path ? own.starts_with(of) && own.find('.', of.size()) == std::string::npos : own == of);
    };
    for (const Signal& signal : signals_)
      if (belongs(signal)) variables.insert(variable(signal.name));
    if (variables.size() != 1) continue;  // of which
    for (Signal& signal : signals_)
      if (belongs(signal) && signal.unit.empty()) signal.unit = unit;
  }
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
  const auto may_be_another = [](const std::string& other) { return folded(last_part(other)) == "rate"; };
  if (interval_ > 0 && may_be_another(name)) return true;  // of a shaft, beside "sr"
  if (interval_ > 0 && !may_be_another(interval_name_) && std::abs(stated - interval_) > 1e-9 * interval_)
    throw InputError({file_}, fmt::format("{} means an interval of {} s beside one of {} s; expected one",
                                          name, stated, interval_));
  set_interval(name, stated);
  return true;
}

void CollectedSignals::find_time(RecordTable& table, const RecordFormat& format) const {
  const auto at = std::find_if(table.names.begin(), table.names.end(),
                               [](const std::string& name) { return time_name(name).time; });
  if (at == table.names.end()) {
    if (interval_ > 0) table.clock = {0.0, interval_};
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
  if (*factor == 1.0) table.time = column;  // else found by its unit
  const std::vector<double>& times = table.columns[column];
  const double mean = *factor * (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  constexpr double tolerated = 0.02;
  if (interval_ > 0 && !format.time && !format.sampling_rate &&
      std::abs(mean - interval_) > tolerated * interval_)
    throw InputError(
        {file_},
        fmt::format("{} means an interval of {:.6g} s, and '{}' has one of {:.6g} s; expected them to "
                    "agree, or record.time or record.sampling_rate_hz in the configuration",
                    interval_name_, interval_, *at, mean));
}

std::size_t CollectedSignals::common_length() const {
  std::map<std::size_t, std::size_t> numbers;  // of each length
  for (const Signal& signal : signals_) numbers[signal.values.size()] += signal.values.size();
  if (numbers.empty())
    throw InputError({file_},
                     "no signal of at least two numbers; expected vectors or matrices of real numbers");
  return std::max_element(numbers.begin(), numbers.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
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
    table.units.push_back(signal.unit);
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
