#include "experiments/inspection/inspection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "experiments/input/record_columns.hpp"
#include "experiments/input/record_reader.hpp"
#include "experiments/inspection/noise_floor.hpp"
#include "experiments/signal/median.hpp"
#include "experiments/signal/spectrum.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

/// Increases at steps that are even within a tenth; a few rows may be at fault.
bool looks_like_time(const std::vector<double>& values) {
  if (values.size() < 16) return false;
  const double step = (values.back() - values.front()) / static_cast<double>(values.size() - 1);
  if (!(step > 0)) return false;
  std::size_t even = 0;
  for (std::size_t i = 1; i < values.size(); ++i)
    even += std::abs(values[i] - values[i - 1] - step) < 0.1 * step;
  return static_cast<double>(even) > 0.99 * static_cast<double>(values.size() - 1);
}

bool is_named_time(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return name == "t" || name.starts_with("time");
}

/// The column of time, and what is said of it.
std::optional<RecordColumn> find_time(const RecordTable& table, const RecordFormat& format,
                                      std::string& text) {
  const auto titled = [&](std::size_t index) {
    return index < table.names.size() && !table.names[index].empty()
               ? fmt::format("column {}, '{}'", index + 1, table.names[index])
               : fmt::format("column {}", index + 1);
  };
  if (format.time) {
    const RecordColumn column{find_index(table, *format.time), format.time->factor, {}};
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
      text = fmt::format(
          "Nothing states which column is time: {} increases at even steps and is taken for seconds "
          "(--time {} confirms it, --time {}:ms says otherwise).",
          titled(index), index + 1, index + 1);
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
    interval = 1 / *format.sampling_rate, found.resolution = 0.0;
    found.time_text += fmt::format("{}Counted at {:.9g} Hz, as stated.", found.time_text.empty() ? "" : " ",
                                   *format.sampling_rate);
  }
  for (std::size_t i = 0; i < found.time.size(); ++i)
    found.time[i] = start + interval * static_cast<double>(i);
}

void analyse(InspectedChannel& channel, double interval) {
  VectorXd signal =
      Eigen::Map<const VectorXd>(channel.samples.data(), static_cast<Index>(channel.samples.size()));
  channel.clipped = clipped_runs(channel.samples);
  channel.dropped = dropped_runs(channel.samples);
  double last = 0.0;
  for (const double value : channel.samples)
    if (std::isfinite(value)) {
      last = value;
      break;
    }
  for (Index k = 0; k < signal.size(); ++k) {
    if (std::isfinite(signal[k]))
      last = signal[k];
    else
      signal[k] = last, ++channel.missing;
  }
  channel.offset = median(signal);
  channel.least = signal.minCoeff(), channel.greatest = signal.maxCoeff();
  const VectorXd place = VectorXd::LinSpaced(signal.size(), -0.5, 0.5);
  channel.drift = place.dot(signal) / place.squaredNorm();
  channel.dead = !(channel.greatest > channel.least);
  constexpr Index fewest = 64;
  if (channel.dead || signal.size() < fewest) return;
  channel.noise = noise_floor(signal);
  const double power = (signal.array() - signal.mean()).square().mean();
  const double noise = channel.noise * channel.noise;
  channel.signal_to_noise_db =
      10 * std::log10(std::max(power - noise, 1e-3 * noise) / std::max(noise, 1e-300));
  constexpr double far_larger = 1e3;
  channel.dead = std::abs(channel.offset) > far_larger * std::sqrt(power);
  if (channel.dead) return;
  channel.frequency_hz = strongest_frequency(signal, interval);
  channel.events = find_events(signal, interval, channel.noise, channel.frequency_hz);
  if (!channel.events.empty() && channel.events.front().pulse) channel.frequency_hz = 0;  // pulses have none
}

InspectedChannel make_channel(const RecordTable& table, std::size_t index,
                              const ColumnDescription* described) {
  InspectedChannel channel;
  channel.column = static_cast<int>(index) + 1;
  channel.samples = table.columns[index];
  if (index < table.names.size()) channel.name = table.names[index];
  if (index < table.units.size()) channel.unit = table.units[index];
  double factor = 1.0;
  if (described != nullptr && described->stated)
    channel.quantity = described->quantity, factor = described->factor;
  else if (const auto meaning = stated_meaning(table, index); meaning && meaning->quantity)
    channel.quantity = *meaning->quantity, factor = meaning->factor;
  if (channel.quantity) channel.unit = si_unit(*channel.quantity);
  for (double& value : channel.samples) value *= factor;
  return channel;
}

void cut(Inspection& found, const RecordFormat& format) {
  const auto& [from, to] = *format.window;
  std::vector<bool> kept(found.time.size());
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = found.time[i] >= from && found.time[i] <= to;
  constexpr std::ptrdiff_t fewest = 16;
  if (std::count(kept.begin(), kept.end(), true) < fewest)
    throw InputError(
        format.window_place.file.empty() ? Place{found.file} : format.window_place,
        fmt::format("window {} to {} s; expected at least 16 samples inside the record, which runs from "
                    "{} to {} s",
                    from, to, found.time.front(), found.time.back()));
  const auto compact = [&](std::vector<double>& values) {
    std::size_t next = 0;
    for (std::size_t i = 0; i < kept.size(); ++i)
      if (kept[i]) values[next++] = values[i];
    values.resize(next);
  };
  for (InspectedChannel& channel : found.channels) compact(channel.samples);
  compact(found.time);
}

}  // namespace

Inspection inspect(const std::filesystem::path& file, const RecordFormat& format) {
  RecordFormat tolerant = format;
  tolerant.skip_malformed = true;
  Inspection found;
  found.file = file.filename().string();
  found.reader = reader_of(file, format);
  RecordTable table = read_table(file, tolerant);
  found.skipped_lines = table.skipped_lines;
  std::optional<RecordColumn> time = find_time(table, format, found.time_text);
  if (time) {  // a row without its instant says nothing
    std::vector<bool> kept(table.rows());
    for (std::size_t row = 0; row < kept.size(); ++row) {
      kept[row] = std::isfinite(table.columns[time->index][row]);
      if (!kept[row] && row < table.lines.size()) found.skipped_lines.push_back(table.lines[row]);
    }
    table.keep(kept);
  }
  if (table.rows() < 2) throw InputError({table.file}, "fewer than two rows of numbers; expected a record");
  set_time(table, format, time, found);
  if (format.channels.empty()) {
    for (std::size_t index = 0; index < table.width(); ++index)
      if (!time || index != time->index) found.channels.push_back(make_channel(table, index, nullptr));
  } else {
    for (const ColumnDescription& wanted : format.channels)
      found.channels.push_back(make_channel(table, find_index(table, wanted), &wanted));
  }
  if (found.channels.empty())
    throw InputError({table.file}, "no column but time; expected a measured quantity");
  if (format.window) cut(found, format);
  found.sampling = check_sampling(found.time, found.resolution);
  const double mean = (found.time.back() - found.time.front()) / static_cast<double>(found.time.size() - 1);
  for (InspectedChannel& channel : found.channels)
    analyse(channel, found.sampling.uniform && mean > 0 ? mean : std::max(found.sampling.interval, 1e-300));
  found.remarks = table.remarks;
  return found;
}

}  // namespace beamid::experiments
