#include "experiments/record/inspect/time_column.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace beamid::experiments {
namespace {

/// Rises from row to row; a few rows may be at fault.
bool looks_like_time(const std::vector<double>& values) {
  constexpr std::size_t fewest = 16;
  constexpr double share = 0.99;
  if (values.size() < fewest) return false;
  std::size_t rising = 0;
  for (std::size_t i = 1; i < values.size(); ++i) rising += values[i] > values[i - 1];
  return static_cast<double>(rising) > share * static_cast<double>(values.size() - 1);
}

bool is_named_time(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return name == "t" || name.starts_with("time") || name.starts_with("t_") || name.starts_with("t ") ||
         name.starts_with("t[") || name.starts_with("t(");
}

/// The line of [record] that names the column of time.
std::string time_key(const RecordColumn& column) {
  const std::string unit = column.factor == 1 ? "s" : column.factor == 1e-3 ? "ms" : "us";
  return fmt::format("time = {{ column = {}, unit = \"{}\" }}", column.index + 1, unit);
}

}  // namespace

std::optional<RecordColumn> find_time(const RecordTable& table, const RecordFormat& format, std::string& text,
                                      std::string& key) {
  const auto titled = [&](std::size_t index) {
    return index < table.names.size() && !table.names[index].empty()
               ? fmt::format("column {}, '{}'", index + 1, table.names[index])
               : fmt::format("column {}", index + 1);
  };
  if (format.time) {
    const RecordColumn column{find_index(table, *format.time), format.time->factor, {}};
    key = time_key(column);
    text = "Time is " + titled(column.index) + ".";
    return column;
  }
  for (std::size_t index = 0; index < table.width(); ++index)
    if (const auto meaning = stated_meaning(table, index); meaning && !meaning->quantity) {
      text = "Time is " + titled(index) + ".";
      return RecordColumn{index, meaning->factor, {}};
    }
  if (table.clock || format.sampling_rate) return std::nullopt;
  for (const bool named : {true, false})
    for (std::size_t index = 0; index < table.width(); ++index) {
      if (named && !(index < table.names.size() && is_named_time(table.names[index]))) continue;
      if (!looks_like_time(table.columns[index])) continue;
      if (!named && index > 0) return std::nullopt;  // a column further on may rise for other reasons
      text = fmt::format(
          "Nothing states which column is time: {} rises throughout and is taken for seconds "
          "(--time {} confirms it, --time {}:ms says otherwise).",
          titled(index), index + 1, index + 1);
      key = time_key({index, 1, {}});
      return RecordColumn{index, 1, {}};
    }
  return std::nullopt;
}

void set_time(const RecordTable& table, const RecordFormat& format, const std::optional<RecordColumn>& column,
              Inspection& found) {
  found.time.resize(table.rows());
  double start = 0.0, interval = 1.0;
  if (column) {
    const std::vector<double>& stamps = table.columns[column->index];
    for (std::size_t i = 0; i < stamps.size(); ++i) found.time[i] = stamps[i] * column->factor;
    found.resolution = column->factor * std::max(table.precision[column->index].resolution(stamps.front()),
                                                 table.precision[column->index].resolution(stamps.back()));
    if (!format.sampling_rate) return;
    start = found.time.front();
  } else if (table.clock) {
    start = table.clock->start, interval = table.clock->interval;
    found.time_text = fmt::format("The file states an interval of {:.9g} s.", interval);
  } else if (!format.sampling_rate) {
    found.has_time = false;
    found.time_text =
        "Nothing tells the time: samples are counted, frequencies are per sample (--rate HZ states it).";
  }
  if (format.sampling_rate) {
    found.time_key += fmt::format("{}sampling_rate_hz = {:.12g}", found.time_key.empty() ? "" : "\n",
                                  *format.sampling_rate);
    interval = 1 / *format.sampling_rate, found.resolution = 0.0;
    found.time_text += fmt::format("{}Counted at {:.9g} Hz, as stated.", found.time_text.empty() ? "" : " ",
                                   *format.sampling_rate);
  }
  for (std::size_t i = 0; i < found.time.size(); ++i)
    found.time[i] = start + interval * static_cast<double>(i);
}

}  // namespace beamid::experiments
