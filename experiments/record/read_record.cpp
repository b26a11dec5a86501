#include "experiments/record/read_record.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "experiments/record/record.hpp"
#include "experiments/record/record_columns.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/record/stamps.hpp"
#include "experiments/signal/interpolation.hpp"
#include "experiments/signal/toolbox.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/input_error.hpp"

namespace beamid::experiments {
namespace {

// One record from several files, a sensor or more each.

using Eigen::Index, Eigen::VectorXd;

struct RecordPart {
  std::string file, stem;
  Record record;

  double start() const { return record.time[0]; }
  double end() const { return record.time[record.size() - 1]; }
};

/// What each file has: the channels that are asked of it, or all that it describes itself.
std::vector<RecordPart> parts_of(const RecordFormat& format) {
  std::vector<RecordPart> parts;
  for (std::size_t i = 0; i < format.files.size(); ++i) {
    RecordFormat one = format;
    one.files.clear();
    one.window.reset();
    one.own_clock.clear();
    std::erase_if(one.channels,
                  [&](const ColumnDescription& channel) { return channel.file != static_cast<int>(i) + 1; });
    if (one.channels.empty() && !format.channels.empty()) continue;
    const std::filesystem::path file = format.files[i];
    parts.push_back({file.string(), file.stem().string(), read_record(file, one)});
  }
  return parts;
}

/// A file's name says which sensor it is: the channel's own where several files use one name.
void name_apart(std::vector<RecordPart>& parts) {
  std::vector<std::string> names;
  for (const RecordPart& part : parts)
    for (const Channel& channel : part.record.channels) names.push_back(channel.name);
  for (RecordPart& part : parts)
    for (Channel& channel : part.record.channels)
      if (std::ranges::count(names, channel.name) > 1)
        channel.name = part.record.channels.size() == 1 ? part.stem : part.stem + " " + channel.name;
}

/// What all files have in common [s].
std::pair<double, double> common_part(const std::vector<RecordPart>& parts) {
  double from = parts.front().start(), to = parts.front().end();
  for (const RecordPart& part : parts) {
    from = std::max(from, part.start());
    to = std::min(to, part.end());
  }
  return {from, to};
}

/// Whether the stamps of all files are those of one clock.
bool share_clock(const std::vector<RecordPart>& parts) {
  constexpr double least = 0.5;  // of the shortest, in common
  double shortest = parts.front().end() - parts.front().start();
  for (const RecordPart& part : parts) shortest = std::min(shortest, part.end() - part.start());
  const auto [from, to] = common_part(parts);
  return to - from >= least * shortest;
}

/// One channel at other instants within its own.
VectorXd brought_to(const VectorXd& instants, const RecordPart& part, Index row) {
  constexpr double same = 0.02;  // of an interval
  const VectorXd& time = part.record.time;
  const Index first = std::clamp<Index>(
      std::lower_bound(time.begin(), time.end(), instants[0] - 0.5 * part.record.interval()) - time.begin(),
      0, time.size() - 1);
  if (first + instants.size() <= time.size() &&
      (time.segment(first, instants.size()) - instants).cwiseAbs().maxCoeff() < same * part.record.interval())
    return part.record.samples.row(row).segment(first, instants.size()).transpose();
  if (!part.record.samples.row(row).allFinite())
    throw InputError({part.file},
                     "readings are missing between the stamps of the other files; expected every "
                     "sample of a file whose stamps are others");
  return BandLimited(time, part.record.samples.row(row).transpose())(instants);
}

/// Reads the channels of each of the format's files and joins them by their stamps. The part that all files
/// have in common is kept, at the stamps of the file that is sampled fastest: others that lie between those
/// are brought there by band-limited interpolation (interpolation.hpp), and remarks name them. Files whose
/// stamps have less than half of the shorter one in common have no common clock: each is counted from its own
/// beginning, and Record::own_clock names the channels of all but the first.
/// @throws InputError as read_record(), and where a file that has to be interpolated lacks readings.
Record joined_record(const RecordFormat& format) {
  constexpr Index fewest = 16;
  std::vector<RecordPart> parts = parts_of(format);
  name_apart(parts);
  Record joined;
  joined.own_clock = format.own_clock;
  joined.input_path = format.input;
  const bool one_clock = share_clock(parts);
  if (!one_clock)
    for (std::size_t i = 1; i < parts.size(); ++i) {
      parts[i].record.time.array() += parts[0].start() - parts[i].start();
      for (const Channel& channel : parts[i].record.channels) joined.own_clock.push_back(channel.name);
    }
  const auto [from, to] = common_part(parts);
  const RecordPart* fastest = &parts.front();
  for (const RecordPart& part : parts)
    if (part.record.interval() < 0.999 * fastest->record.interval()) fastest = &part;
  const VectorXd& stamps = fastest->record.time;
  const double rounding = 1e-6 * fastest->record.interval();
  const Index first = std::lower_bound(stamps.begin(), stamps.end(), from - rounding) - stamps.begin(),
              last = std::upper_bound(stamps.begin(), stamps.end(), to + rounding) - stamps.begin();
  if (last - first < fewest)
    throw InputError({format.files.front()},
                     fmt::format("{} samples in common of {} files; expected {} at least", last - first,
                                 parts.size(), fewest));
  joined.time = stamps.segment(first, last - first);
  joined.time_resolution = fastest->record.time_resolution;
  std::string others;
  for (const RecordPart& part : parts) {
    for (std::size_t c = 0; c < part.record.channels.size(); ++c) {
      joined.samples.conservativeResize(joined.samples.rows() + 1, joined.time.size());
      joined.samples.bottomRows(1) =
          brought_to(joined.time.cwiseMax(part.start()).cwiseMin(part.end()), part, static_cast<Index>(c))
              .transpose();
      joined.channels.push_back(part.record.channels[c]);
    }
    if (std::abs(part.record.interval() / fastest->record.interval() - 1.0) > 1e-3)
      others += fmt::format("; {} is brought there from {:.6g} Hz", part.stem, 1.0 / part.record.interval());
    for (const std::string& remark : part.record.remarks)
      if (std::ranges::find(joined.remarks, remark) == joined.remarks.end()) joined.remarks.push_back(remark);
    for (const Objection& one : part.record.objections)
      joined.objections.emplace_back(one.name, part.stem + ": " + one.text);
  }
  joined.remarks.push_back(fmt::format(
      "{} files joined {}: {} samples in common at {:.6g} Hz{}.", parts.size(),
      one_clock ? "by their stamps" : "from their beginnings, as their stamps have no common zero",
      joined.size(), 1.0 / joined.interval(), others));
  return joined;
}

/// The stamps of a record in the file's unit, and where they stand.
struct Stamps {
  const RecordTable* table;
  std::optional<RecordColumn> column;
  const RecordFormat* format;

  const std::vector<double>& values() const { return table->columns[column->index]; }
  const PrintedPrecision& precision() const { return table->precision[column->index]; }
  double factor() const { return column->factor; }
  /// How finely they are printed where they are printed most coarsely.
  double resolution() const {
    return std::max(precision().resolution(values().front()), precision().resolution(values().back()));
  }
  /// Whether their rounding leaves an interval to be seen.
  bool show_intervals() const { return resolution() < 0.5 * mean_step(values()); }
  /// Several samples of one stamp, or next to each other, as of one transfer.
  bool come_in_bursts() const {
    constexpr double close = 0.25, often = 0.3;  // of the mean step, of the samples
    const double next = close * mean_step(values());
    std::size_t count = 0;
    for (std::size_t k = 1; k < values().size(); ++k) count += values()[k] - values()[k - 1] < next ? 1 : 0;
    return static_cast<double>(count) > often * static_cast<double>(values().size());
  }
  double rounding(std::size_t sample) const { return precision().resolution(values()[sample]) * factor(); }
};

/// A file's header rounds its interval.
void check_interval(double interval, double rate, const std::string& file) {
  constexpr double tolerated = 0.02;
  if (!(std::abs(interval * rate - 1) <= tolerated))
    throw InputError({file},
                     fmt::format("samples at an interval of {:.6g} s; expected {:.6g} s within 2 %, by "
                                 "the sampling rate of {:.6g} Hz",
                                 interval, 1 / rate, rate));
}

/// Stamps of transfers, each of a few samples: where steps beyond 2.5 of the usual one end at most 64 samples
/// each, and take half of the time.
/// @throws InputError there
void refuse_bursts(const Stamps& stamps) {
  constexpr std::size_t fewest = 10, most_samples = 64;
  constexpr double pause = 2.5, much = 0.5;  // of the usual step, of the time
  const std::vector<double>& times = stamps.values();
  const std::size_t steps = times.size() - 1;
  if (const auto [shortest, longest] = range_of_steps(times); longest <= pause * shortest) return;
  const double usual = usual_step(times);
  std::size_t pauses = 0;
  double passed = 0.0;
  for (std::size_t k = 1; k < times.size(); ++k)
    if (const double step = times[k] - times[k - 1]; step > pause * usual) ++pauses, passed += step;
  const double length = times.back() - times.front();
  if (pauses < fewest || steps > most_samples * pauses || passed < much * length) return;
  throw InputError(
      stamps.table->place(0, stamps.column->index),
      fmt::format(
          "times in {} bursts of about {} samples, {:.3g} s apart in a burst: they are those of transfers; "
          "expected "
          "the sampling rate: --rate HZ (the mean is about {:.3g}), or record.sampling_rate_hz in the "
          "configuration",
          pauses + 1, (times.size() + pauses / 2) / (pauses + 1), usual * stamps.factor(),
          static_cast<double>(steps) / (length * stamps.factor())));
}

/// Whether stamps that come in bursts, or late, run at the stated rate: the line through all of them does, to
/// half an interval over the record.
bool run_at(const Stamps& stamps, double rate) {
  const std::vector<double>& times = stamps.values();
  const auto size = static_cast<Eigen::Index>(times.size());
  const Eigen::ArrayXd off = (Eigen::Map<const Eigen::ArrayXd>(times.data(), size) - times[0]) *
                                 stamps.factor() -
                             Eigen::ArrayXd::LinSpaced(size, 0.0, static_cast<double>(size - 1)) / rate,
                       count = Eigen::ArrayXd::LinSpaced(size, -0.5, 0.5);
  const double drift = (count * (off - off.mean())).sum() / count.square().sum();  // over the record
  return std::abs(drift) < 0.5 / rate + stamps.rounding(0);
}

/// Counted at the stated rate from the first stamp, no sample may be half an interval away from its own.
void check_stamps(const Stamps& stamps, double rate) {
  const std::vector<double>& times = stamps.values();
  const std::size_t last = times.size() - 1;
  for (std::size_t k = 1; k <= last; ++k) {
    const double stamp = times[k] * stamps.factor(),
                 counted = times[0] * stamps.factor() + static_cast<double>(k) / rate;
    if (std::abs(stamp - counted) <= (0.5 / rate + stamps.rounding(k) + stamps.rounding(0)) * (1 + 1e-9))
      continue;
    throw InputError(
        stamps.table->place(k, stamps.column->index),
        fmt::format(
            "time {:.13g} s of sample {}, which {:.9g} Hz, as stated, puts at {:.13g} s: the stamps run at "
            "{:.9g} Hz in the mean; expected them within half an interval. Without a stated rate the stamps "
            "are taken as they are",
            stamp, k + 1, rate, counted,
            static_cast<double>(last) / ((times[last] - times[0]) * stamps.factor())));
  }
}

Eigen::VectorXd counted(double start, double interval, std::size_t size, const std::string& file) {
  const auto count = static_cast<Eigen::Index>(size);
  Eigen::VectorXd times =
      start + Eigen::ArrayXd::LinSpaced(count, 0, static_cast<double>(size - 1)) * interval;
  if (!((times.tail(count - 1) - times.head(count - 1)).minCoeff() > 0.0))
    throw InputError(
        {file},
        fmt::format(
            "begins at {:g} s, where an interval of {:g} s is lost in rounding; expected times that increase",
            start, interval));
  return times;
}

/// Samples that share stamps. @throws InputError where these do not determine their rate
Eigen::VectorXd counted_from(const SharedStamps& shared, const Stamps& stamps,
                             std::vector<std::string>& remarks) {
  const double step = shared.step * stamps.factor(), rate = shared.mean / step;
  if (!shared.even())
    throw InputError(
        stamps.table->place(0, stamps.column->index),
        fmt::format("{} to {} samples share each stamp of {:.6g} s; expected the sampling rate, "
                    "about {:.4g} Hz: --rate HZ, or record.sampling_rate_hz in the configuration",
                    shared.fewest, shared.most, step, rate));
  remarks.push_back(fmt::format("{} samples share each stamp of {:.6g} s: they are counted at {:.6g} Hz.",
                                shared.most, step, rate));
  return counted(shared.first * stamps.factor(), 1.0 / rate, stamps.table->rows(), stamps.table->file);
}

/// The instants (N) [s]. @param remarks to which it adds what was done to them
Eigen::VectorXd instants(const Stamps& stamps, std::vector<std::string>& remarks) {
  const RecordTable& table = *stamps.table;
  const std::size_t size = table.rows();
  std::optional<double> rate = stamps.format->sampling_rate;
  if (!rate && stamps.column && table.stated_rate && !rises(stamps.values()) &&
      run_at(stamps, *table.stated_rate))
    rate = table.stated_rate;  // stamps that are printed too coarsely
  if (!stamps.column) {
    if (!table.clock) return counted(0, 1 / *rate, size, table.file);
    if (rate) check_interval(table.clock->interval, *rate, table.file);
    return counted(table.clock->start, rate ? 1 / *rate : table.clock->interval, size, table.file);
  }
  const std::vector<double>& times = stamps.values();
  if (rate) {
    if (stamps.come_in_bursts() && run_at(stamps, *rate))
      remarks.push_back(
          fmt::format("The stamps come in bursts, or are printed coarsely, and run at {:.6g} Hz in the mean: "
                      "samples are counted.",
                      *rate));
    else
      check_stamps(stamps, *rate);
    return counted(times[0] * stamps.factor(), 1 / *rate, size, table.file);
  }
  if (const auto shared = shared_stamps(times, table.columns)) return counted_from(*shared, stamps, remarks);
  auto fault = find_order_fault(times);
  // Times printed to whole intervals show which rows are missing; that some are is stated.
  const bool show_gaps =
      stamps.format->malformed == MalformedRows::as_missing && find_missing_rows(times, stamps.precision());
  if (!fault && !(stamps.format->irregular && (stamps.show_intervals() || show_gaps)))
    fault = find_sampling_fault(times, stamps.precision());
  if (fault) throw InputError(table.place(fault->sample, stamps.column->index), fault->message);
  refuse_bursts(stamps);
  const auto in_seconds = [&](const std::vector<double>& values) -> Eigen::VectorXd {
    return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(size)) *
           stamps.factor();
  };
  const auto even = without_rounding(times, stamps.resolution());
  if (!even) return in_seconds(times);
  remarks.push_back(fmt::format(
      "The stamps are printed to {:.3g} s and lie on even instants within that: those of the line "
      "through all of them are taken, {:.8g} Hz.",
      stamps.resolution() * stamps.factor(), 1.0 / (even->interval * stamps.factor())));
  return in_seconds(even->times);
}

/// How finely the instants were printed [s]; 0 where coarser than half of their interval, which the stamps
/// then are multiples of.
double resolution(const Stamps& stamps, const Record& record) {
  const double printed = stamps.resolution() * stamps.factor();
  return printed < 0.5 * record.interval() ? printed : 0.0;
}

Record cut(const Record& record, const RecordFormat& format, const std::string& file) {
  try {
    return record.window(format.window->first, format.window->second);
  } catch (const std::invalid_argument& error) {
    throw InputError(format.window_place.file.empty() ? Place{file, 0, 0} : format.window_place,
                     error.what());
  }
}

/// Whether a cell says that nothing was read.
bool is_missing(const RecordTable& table, std::size_t row, std::size_t column) {
  if (!table.cell) return std::isnan(table.columns[column][row]);
  return says_missing(table.cell(row, column).text);
}

/// A column that is read, and what one of its unit is in that of the record.
struct Used {
  std::size_t index;
  double factor;
};

/// Refuses the first row in which a column that is used holds no number that is finite in the record's unit,
/// or leaves all such rows out, or takes what is missing for missing.
/// @param time which of them is the stamps
void check_rows(RecordTable& table, const std::vector<Used>& used, std::optional<std::size_t> time,
                MalformedRows malformed) {
  std::vector<bool> kept(table.rows(), true);
  std::vector<std::size_t> lines = table.skipped_lines;
  constexpr std::size_t fewest = 16;
  std::size_t rows = table.rows();
  while (time && table.cell && rows > fewest && !std::isfinite(table.columns[*time][rows - 1])) {
    const std::string cell = table.cell(rows - 1, *time).text;  // "Max", "Mean" below the record
    const bool empty = std::ranges::none_of(
        used, [&](const Used& one) { return std::isfinite(table.columns[one.index][rows - 1]); });
    if ((says_missing(cell) && !empty) || cell.find_first_of("0123456789") != cell.npos) break;
    kept[--rows] = false;
    lines.push_back(table.line_of(rows));
  }
  for (std::size_t row = 0; row < rows; ++row)
    for (const auto& [column, factor] : used) {
      if (std::isfinite(table.columns[column][row] * factor)) continue;
      if (malformed == MalformedRows::as_missing && column != time && is_missing(table, row, column))
        continue;
      if (malformed != MalformedRows::skip) throw table.fault(row, column);
      if (kept[row]) lines.push_back(table.line_of(row));
      kept[row] = false;
    }
  std::sort(lines.begin(), lines.end());
  if (lines.empty()) return;
  table.remarks.push_back(skipped_text(lines, "is not a row of numbers like the others"));
  table.keep(kept);
}

}  // namespace

Record read_record(const std::filesystem::path& file, const RecordFormat& format) {
  if (format.files.size() > 1) {
    Record joined = joined_record(format);
    if (!format.window) return joined;
    return cut(joined, format, file.string());
  }
  RecordTable table = read_table(file, format);
  RecordColumns columns = find_columns(table, format);
  std::vector<Used> used;
  if (columns.time) used.push_back({columns.time->index, 1.0});
  for (const RecordColumn& column : columns.channels) used.push_back({column.index, column.factor});
  // A file that nobody described has its gaps: what says that nothing was read is missing.
  const bool has_gaps = columns.recognised && format.malformed == MalformedRows::refuse;
  check_rows(table, used, columns.time ? std::optional(columns.time->index) : std::nullopt,
             has_gaps ? MalformedRows::as_missing : format.malformed);
  if (table.rows() < 2)
    throw InputError(
        table.rows() ? table.row_place(table.rows() - 1) : Place{table.file},
        fmt::format("{} of numbers; expected at least two", table.rows() ? "one row" : "no row"));
  if (columns.recognised) leave_out_still(table, columns);
  if (columns.recognised) leave_out_repeated(table, columns);
  if (columns.recognised && !format.sampling_rate && !table.clock) keep_updates(table, columns);

  Record record;
  const Stamps stamps{&table, columns.time, &format};
  record.time = instants(stamps, table.remarks);
  if (columns.time && !format.sampling_rate) record.time_resolution = resolution(stamps, record);
  table.cell = nullptr;  // of a long record, the text takes the most memory
  record.samples.resize(static_cast<Eigen::Index>(columns.channels.size()),
                        static_cast<Eigen::Index>(table.rows()));
  for (std::size_t channel = 0; channel < columns.channels.size(); ++channel) {
    const RecordColumn& column = columns.channels[channel];
    const std::vector<double>& values = table.columns[column.index];
    record.samples.row(static_cast<Eigen::Index>(channel)) =
        Eigen::Map<const Eigen::RowVectorXd>(values.data(), record.samples.cols()) * column.factor;
    record.channels.push_back(column.channel);
  }
  record.input_path = format.input;
  record.own_clock = format.own_clock;
  record.remarks = table.remarks;
  for (const std::string& text : table.warnings) record.objections.emplace_back("file", text);
  std::vector<std::string> names;
  for (const RecordColumn& column : columns.channels)
    names.push_back(column.index < table.names.size() ? table.names[column.index] : "");
  take_places(file, names, record);
  if (!format.window) return record;
  return cut(record, format, table.file);
}

}  // namespace beamid::experiments
