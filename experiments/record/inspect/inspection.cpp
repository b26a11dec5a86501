#include "experiments/record/inspect/inspection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "experiments/record/inspect/noise_floor.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/record/record_columns.hpp"
#include "experiments/record/record_reader.hpp"
#include "experiments/record/units.hpp"
#include "experiments/signal/median.hpp"
#include "experiments/signal/missing_samples.hpp"
#include "experiments/signal/spectrum.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

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

/// The column of time, what is said of it, and what would state it.
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

/// Even samples without a hole, for what looks at a whole signal: straight lines across what is missing.
struct EvenSignal {
  VectorXd time, signal;
  double interval = 1;
};

EvenSignal even_signal(const std::vector<double>& time, const VectorXd& samples, double resolution) {
  constexpr Index fewest = 16;
  std::vector<Index> kept;  // stamps that come after all before them
  for (Index k = 0; k < samples.size(); ++k)
    if (kept.empty() || time[k] > time[static_cast<std::size_t>(kept.back())]) kept.push_back(k);
  Record record;
  record.time = Eigen::Map<const VectorXd>(time.data(), samples.size())(kept);
  record.samples = samples(kept).transpose();
  record.channels.resize(1);
  record.time_resolution = resolution;
  if (record.size() >= fewest && !evenly_sampled(record))
    step_registry().make("resample", step_registry().completed("resample", {}))->apply(record);
  const double interval = record.size() > 1 ? record.interval() : 1;
  return {record.time, bridged_straight(record.samples.row(0).transpose()), interval};
}

/// Rests between pulses, as a hammer's force does: nothing in it is then too short or held for too long.
bool rests(const InspectedChannel& channel) {
  constexpr double smallest = 0.05, most_of_it = 0.95;
  std::vector<double> distance;
  for (const double value : channel.samples)
    if (std::isfinite(value)) distance.push_back(std::abs(value - channel.offset));
  if (distance.empty()) return false;
  const double level = smallest * *std::max_element(distance.begin(), distance.end());
  const auto resting = std::count_if(distance.begin(), distance.end(), [&](double d) { return d <= level; });
  const auto longest = [&] {  // of what goes further: a spike is one sample, and most of them are alone
    std::size_t run = 0, most = 0;
    for (const double d : distance) most = std::max(most, run = d > level ? run + 1 : 0);
    return most;
  }();
  return static_cast<double>(resting) > most_of_it * static_cast<double>(distance.size()) && longest > 2;
}

void inspect_channels(const Inspection& found, InspectedChannel& channel) {
  constexpr Index fewest = 64;
  std::vector<double> finite;
  for (const double value : channel.samples)
    if (std::isfinite(value)) finite.push_back(value);
  channel.missing = channel.samples.size() - finite.size();
  if (finite.empty()) {
    channel.defects.dead = true;
    return;
  }
  channel.offset = median(finite);
  channel.least = *std::min_element(finite.begin(), finite.end());
  channel.greatest = *std::max_element(finite.begin(), finite.end());
  const bool force = channel.quantity ? *channel.quantity == Quantity::force : rests(channel);
  channel.defects = find_defects(channel.samples, force ? SignalKind::force : SignalKind::motion);
  if (channel.defects.dead || std::ssize(finite) < fewest) return;
  VectorXd samples = Eigen::Map<const VectorXd>(channel.samples.data(), std::ssize(channel.samples));
  for (const auto* runs : {&channel.defects.spikes, &channel.defects.dropped})
    for (const Run& run : *runs)
      samples.segment(static_cast<Index>(run.first), static_cast<Index>(run.length))
          .setConstant(std::nan(""));
  const auto [time, signal, interval] = even_signal(found.time, samples, found.resolution);
  if (signal.size() < fewest) return;
  const VectorXd place = VectorXd::LinSpaced(signal.size(), -0.5, 0.5);
  channel.drift = place.dot(signal) / place.squaredNorm();
  channel.noise = noise_floor(signal);
  const double power = (signal.array() - signal.mean()).square().mean();
  const double noise = channel.noise * channel.noise;
  channel.signal_to_noise_db =
      10 * std::log10(std::max(power - noise, 1e-3 * noise) / std::max(noise, 1e-300));
  if (!(signal.maxCoeff() > signal.minCoeff())) return;
  channel.frequency_hz = strongest_frequency(signal, interval);
  channel.events = find_events(signal, interval, channel.noise, channel.frequency_hz);
  take_slow_release(signal, interval, channel.frequency_hz, channel.events);
  if (!channel.events.empty() && channel.events.front().pulse) channel.frequency_hz = 0;  // pulses have none
  if (channel.frequency_hz > 0)
    channel.wandering = offset_drift(signal, 1 / (channel.frequency_hz * interval), channel.noise);
  for (SignalEvent& event : channel.events) {
    const auto at =
        std::lower_bound(found.time.begin(), found.time.end(), time[event.sample] - 0.5 * interval);
    event.sample = std::min<Index>(at - found.time.begin(), std::ssize(found.time) - 1);
  }
  if (channel.wandering)
    channel.wandering->settled =
        std::lower_bound(found.time.begin(), found.time.end(),
                         time[std::min(channel.wandering->settled, time.size() - 1)]) -
        found.time.begin();
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
  if (channel.quantity) {
    channel.unit = si_unit(*channel.quantity);
    for (const Unit& unit : units(*channel.quantity))
      if (unit.factor == factor) channel.file_unit = unit.symbol;
  }
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
  std::optional<RecordColumn> time = find_time(table, format, found.time_text, found.time_key);
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
  for (InspectedChannel& channel : found.channels) inspect_channels(found, channel);
  found.remarks = table.remarks;
  found.remarks.insert(found.remarks.end(), table.warnings.begin(), table.warnings.end());
  return found;
}

}  // namespace beamid::experiments
