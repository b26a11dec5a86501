#include "experiments/record/inspect/inspection.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/record/record_columns.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/record/stamps.hpp"
#include "experiments/record/units.hpp"
#include "experiments/signal/missing_samples.hpp"
#include "experiments/signal/spectrum.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::VectorXd;

SamplingCheck check_sampling(const std::vector<double>& times, double resolution) {
  if (times.size() < 2) throw std::invalid_argument("fewer than two instants; expected at least two");
  std::vector<double> intervals;
  intervals.reserve(times.size() - 1);
  for (std::size_t i = 1; i < times.size(); ++i) intervals.push_back(times[i] - times[i - 1]);
  SamplingCheck check;
  check.interval = median(intervals);
  const double tolerated = 0.05 * check.interval + 1.01 * resolution;
  std::vector<double> from_median(intervals);
  for (double& interval : from_median) interval = std::abs(interval - check.interval);
  const double scatter = median(std::move(from_median)) / check.interval;
  // Where stamps jitter, late ones are no gaps.
  const double late = (scatter > 0.05 ? 2.5 : 1.5) * check.interval + 1.01 * resolution;
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    const double interval = intervals[i];
    if (interval == 0) {
      check.repeats.push_back(i + 1);
    } else if (interval < 0) {
      check.returns.push_back(i + 1);
    } else if (interval > late) {
      check.gaps.push_back(i + 1);
      check.longest_gap = std::max(check.longest_gap, interval);
    } else {
      sum += interval, count += 1.0;
    }
    check.uniform = check.uniform && std::abs(interval - check.interval) <= tolerated;
  }
  const double mean = sum / std::max(count, 1.0);
  for (const double interval : intervals)
    if (interval > 0 && interval <= late) check.jitter += (interval - mean) * (interval - mean);
  check.jitter = std::sqrt(check.jitter / std::max(count, 1.0));
  return check;
}

namespace {

// The instants of a file that is inspected: which column they are, or how else they are known.

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
  return fmt::format("time = {{ column = {}, unit = \"{}\" }}", column.index + 1,
                     symbol_of_time(column.factor));
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
      if (!looks_like_time(table.columns[index]) || counts_samples(table.columns[index])) continue;
      if (!named && index > 0) return std::nullopt;  // a column further on may rise for other reasons
      text = fmt::format(
          "The file does not state which column is time: {} rises throughout and is taken for seconds "
          "(--time {} confirms it, --time {}:ms overrides it).",
          titled(index), index + 1, index + 1);
      key = time_key({index, 1, {}});
      return RecordColumn{index, 1, {}};
    }
  return std::nullopt;
}

/// Instants of all rows from that column, the file's clock or the rate stated; else rows are counted.
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
        "The file states no time: samples are counted, frequencies are per sample (--rate HZ states it).";
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

/// Samples that share a stamp, as where whole seconds are printed, are counted between the stamps.
void count_shared_stamps(const RecordTable& table, Inspection& found) {
  const auto shared = shared_stamps(found.time, table.columns);
  if (!shared) return;
  const double rate = shared->mean / shared->step;
  for (std::size_t i = 0; i < found.time.size(); ++i)
    found.time[i] = shared->first + static_cast<double>(i) / rate;
  found.resolution = 0.0, found.mean_rate = !shared->even();
  found.time_text +=
      found.mean_rate
          ? fmt::format(
                " {} to {} samples share each stamp of {:.6g} s: they are counted here at about {:.4g} Hz, "
                "their mean; other commands need the rate, --rate HZ.",
                shared->fewest, shared->most, shared->step, rate)
          : fmt::format(" {} samples share each stamp of {:.6g} s: they are counted.", shared->most,
                        shared->step);
}

// One channel of a file that is inspected.

/// Even samples without a hole, for what looks at a whole signal: straight lines across what is missing.
struct EvenSignal {
  VectorXd time, signal;
  double interval = 1;
};

EvenSignal even_signal(const std::vector<double>& time, const VectorXd& samples, double resolution) {
  constexpr Index fewest = 16;
  const Eigen::Map<const VectorXd> stamps(time.data(), samples.size());
  Record record;
  if (std::adjacent_find(time.begin(), time.end(), std::greater_equal<>()) == time.end()) {
    record.time = stamps;
    record.samples = samples.transpose();
  } else {
    std::vector<Index> kept;  // stamps that come after all before them
    for (Index k = 0; k < samples.size(); ++k)
      if (kept.empty() || stamps[k] > stamps[kept.back()]) kept.push_back(k);
    record.time = stamps(kept);
    record.samples = samples(kept).transpose();
  }
  record.channels.resize(1);
  record.time_resolution = resolution;
  if (record.size() >= fewest && !evenly_sampled(record))
    step_registry().make("resample", step_registry().completed("resample", {}))->apply(record);
  const double interval = record.size() > 1 ? record.interval() : 1;
  return {std::move(record.time), bridged_straight(record.samples.row(0).transpose()), interval};
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

/// Of a unit of the library, which other commands show by its symbol.
bool is_listed(const std::pair<Quantity, double>& unit) {
  const auto& list = units(unit.first);
  return std::ranges::find(list, unit.second, &Unit::factor) != list.end();
}

/// The unit that the column states or, where it states none, the lines above the columns.
std::optional<std::pair<Quantity, double>> recognised_unit(const RecordTable& table, std::size_t index) {
  if (!table.by_people) return {};
  const auto found = table.names.empty() ? std::nullopt : recognised(table, index);
  const bool named = found && found->states_quantity;
  if (found && found->kind != RecognisedColumn::Kind::signal) return {};
  if (named && found->states_unit) return std::pair{found->quantity, found->factor};
  if (!table.stated_unit || (found && (found->states_unit || !found->reading.empty()))) return {};
  return named && found->quantity != table.stated_unit->first ? std::nullopt : table.stated_unit;
}

/// The column's samples, in SI units where its quantity is stated.
/// @param described by the experiment file; nullptr: not
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
  else if (const auto unit = recognised_unit(table, index); unit && is_listed(*unit))
    channel.quantity = unit->first, factor = unit->second;
  if (channel.quantity) {
    channel.unit = si_unit(*channel.quantity);
    for (const Unit& unit : units(*channel.quantity))
      if (unit.factor == factor) channel.file_unit = unit.symbol;
  }
  for (double& value : channel.samples) value *= factor;
  return channel;
}

/// Defects, noise, frequency and events of the channel's samples at the instants found.
void inspect_channel(const Inspection& found, InspectedChannel& channel) {
  constexpr Index fewest = 64;
  std::vector<double> read = finite(channel.samples);
  const auto count = std::ssize(read);
  channel.missing = channel.samples.size() - read.size();
  if (read.empty()) {
    channel.defects.dead = true;
    return;
  }
  channel.least = *std::min_element(read.begin(), read.end());
  channel.greatest = *std::max_element(read.begin(), read.end());
  channel.offset = median(std::move(read));
  const bool force = channel.quantity ? *channel.quantity == Quantity::force : rests(channel);
  channel.defects = find_defects(channel.samples, force ? SignalKind::force : SignalKind::motion);
  if (channel.defects.dead || count < fewest) return;
  const auto without_defects = [&] {
    VectorXd samples = Eigen::Map<const VectorXd>(channel.samples.data(), std::ssize(channel.samples));
    for (const auto* runs : {&channel.defects.spikes, &channel.defects.dropped})
      for (const Run& run : *runs)
        samples.segment(static_cast<Index>(run.first), static_cast<Index>(run.length))
            .setConstant(std::nan(""));
    return samples;
  };
  const auto [time, signal, interval] = even_signal(found.time, without_defects(), found.resolution);
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

/// The column of time, or the rate that a line above the columns states, as every other command finds them.
std::optional<RecordColumn> recognised_time(RecordTable& table, const RecordFormat& format,
                                            std::string& text) {
  if (!table.by_people || format.time) return {};
  for (std::size_t index = 0; index < table.width(); ++index)
    if (const auto meaning = stated_meaning(table, index); meaning && !meaning->quantity) return {};
  try {
    RecordTable copy(table);
    const RecordColumns columns = find_columns(copy, format);
    if (!columns.time) {
      table.clock = copy.clock;
      return {};
    }
    const std::size_t index = columns.time->index;
    if (copy.rows() == table.rows()) table.columns[index] = copy.columns[index];  // with what starts again
    const std::string name = column_name_of(table, index);
    text =
        fmt::format("Time is column {}{}.", columns.time->index + 1, name.empty() ? "" : ", '" + name + "'");
    return columns.time;
  } catch (const InputError&) {  // a question is left
    return {};
  }
}

}  // namespace

Inspection inspect(const std::filesystem::path& file, const RecordFormat& format) {
  RecordFormat tolerant = format;
  tolerant.malformed = MalformedRows::skip;
  Inspection found;
  found.file = file.filename().string();
  found.reader = reader_of(file, format);
  const auto read = [&]() -> RecordTable {
    try {
      return read_table(file, format);
    } catch (const InputError&) {  // malformed lines
      return read_table(file, tolerant);
    }
  };
  RecordTable table = read();
  found.skipped_lines = table.skipped_lines;
  std::optional<RecordColumn> time = recognised_time(table, format, found.time_text);
  if (!time) time = find_time(table, format, found.time_text, found.time_key);
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
  if (time && !format.sampling_rate) count_shared_stamps(table, found);
  if (format.channels.empty()) {
    for (std::size_t index = 0; index < table.width(); ++index)
      if (!time || index != time->index) found.channels.push_back(make_channel(table, index, nullptr));
  } else {
    for (const ColumnDescription& wanted : format.channels) {
      const std::size_t index = find_index(table, wanted);
      if (wanted.stated) compare_with_header(wanted, index, table);
      found.channels.push_back(make_channel(table, index, &wanted));
    }
  }
  if (found.channels.empty())
    throw InputError({table.file}, "no column but time; expected a measured quantity");
  if (format.window) cut(found, format);
  table.columns.clear(), table.cell = nullptr;  // of a long record, numbers and text take the most memory
  found.sampling = check_sampling(found.time, found.resolution);
  for (InspectedChannel& channel : found.channels) inspect_channel(found, channel);
  found.remarks = table.remarks;
  found.warnings = table.warnings;
  return found;
}

}  // namespace beamid::experiments
