#include "experiments/record/inspect/inspection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/record/inspect/channel_inspection.hpp"
#include "experiments/record/inspect/time_column.hpp"
#include "experiments/record/record_reader.hpp"

namespace beamid::experiments {
namespace {

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

/// The column of time by its name as people write it, or the rate that a line above the columns states.
std::optional<RecordColumn> recognised_time(RecordTable& table, const RecordFormat& format,
                                            std::string& text) {
  if (!table.by_people || format.time || table.names.empty()) return {};
  for (std::size_t index = 0; index < table.width(); ++index)
    if (const auto meaning = stated_meaning(table, index); meaning && !meaning->quantity) return {};
  try {
    RecordTable copy(table);
    const RecordColumns columns = find_columns(copy, format);
    if (!columns.time) {
      table.clock = copy.clock;
      return {};
    }
    text = fmt::format("Time is column {}, '{}'.", columns.time->index + 1, table.names[columns.time->index]);
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
  RecordTable table = read_table(file, tolerant);
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
  found.sampling = check_sampling(found.time, found.resolution);
  for (InspectedChannel& channel : found.channels) inspect_channel(found, channel);
  found.remarks = table.remarks;
  found.warnings = table.warnings;
  return found;
}

}  // namespace beamid::experiments
