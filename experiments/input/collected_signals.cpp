#include "experiments/input/collected_signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace beamid::experiments {
namespace {

/// "data.time" -> "time".
std::string last_part(const std::string& name) {
  const std::size_t at = name.find_last_of("./");
  return at == std::string::npos ? name : name.substr(at + 1);
}

bool is_time(const std::string& name) {
  const std::string last = last_part(name);
  return last == "t" || last == "time" || last == "Time" || last == "time_s";
}

}  // namespace

void CollectedSignals::add(std::string name, std::string unit, std::vector<double> values, int digits) {
  for (double& value : values)
    if (!std::isfinite(value)) value = std::nan("");
  if (values.size() > 1) signals_.push_back({std::move(name), std::move(unit), std::move(values), digits});
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

bool CollectedSignals::set(const std::string& name, double value) {
  const std::string last = last_part(name);
  const bool rate = last == "fs" || last == "Fs" || last == "sampling_rate_hz" || last == "sample_rate";
  const bool interval = last == "dt" || last == "Ts" || last == "Delta_X" || last == "sampling_interval_s";
  if (!rate && !interval) return false;
  if (!(value > 0 && std::isfinite(value)))
    throw InputError({file_}, fmt::format("{} is {}; expected a positive number", name, value));
  const double stated = rate ? 1 / value : value;
  if (interval_ > 0 && std::abs(stated - interval_) > 1e-9 * interval_)
    throw InputError({file_}, fmt::format("{} means an interval of {} s beside one of {} s; expected one",
                                          name, stated, interval_));
  interval_ = stated;
  return true;
}

RecordTable CollectedSignals::table() const {
  std::map<std::size_t, std::size_t> numbers;  // of each length
  for (const Signal& signal : signals_) numbers[signal.values.size()] += signal.values.size();
  if (numbers.empty())
    throw InputError({file_},
                     "no signal of at least two numbers; expected vectors or matrices of real numbers");
  const std::size_t length =
      std::max_element(numbers.begin(), numbers.end(), [](const auto& a, const auto& b) {
        return a.second < b.second;
      })->first;
  RecordTable table;
  table.file = file_;
  std::string others;
  bool units = false;
  for (const Signal& signal : signals_) {
    if (signal.values.size() != length) {
      others += fmt::format("{}{} ({})", others.empty() ? "" : ", ", signal.name, signal.values.size());
      continue;
    }
    if (is_time(signal.name) && !table.time) table.time = table.width();
    units = units || !signal.unit.empty();
    table.names.push_back(signal.name);
    table.units.push_back(signal.unit);
    table.columns.push_back(signal.values);
    table.precision.push_back(PrintedPrecision::of_digits(signal.digits));
  }
  if (!units) table.units.clear();
  if (!table.time && interval_ > 0) table.clock = {0.0, interval_};
  if (!others.empty())
    table.remarks.push_back(fmt::format("Left out, as not of {} samples: {}.", length, others));
  return table;
}

}  // namespace beamid::experiments
