#include "experiments/input/read_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "experiments/input/delimited_text.hpp"
#include "experiments/input/record_columns.hpp"
#include "experiments/input/sampling.hpp"
#include "experiments/input/text_file.hpp"

namespace beamid::experiments {
namespace {

/// The printed times in the file's unit, and where they stand.
struct PrintedTimes {
  std::vector<double> values;
  std::vector<std::pair<std::size_t, std::size_t>> places;  ///< line and column
  PrintedPrecision precision;

  void add(const DelimitedText& text, std::size_t column) {
    const Place place = text.place(column);
    values.push_back(text.number(column));
    places.emplace_back(place.line, place.column);
    precision.add(text.field(column));
  }
};

[[noreturn]] void fail(const std::string& file, const PrintedTimes& times, std::size_t sample,
                       const std::string& message) {
  throw InputError({file, times.places[sample].first, times.places[sample].second}, message);
}

void check_rate(const std::string& file, const PrintedTimes& times, double to_seconds, double rate) {
  constexpr double tolerated = 0.02;
  const std::size_t last = times.values.size() - 1;
  const double first_time = times.values[0], last_time = times.values[last];
  const double mean = (last_time - first_time) * to_seconds / static_cast<double>(last);
  const double rounding =
      std::max(times.precision.resolution(first_time), times.precision.resolution(last_time)) * to_seconds;
  if (!(std::abs(mean * rate - 1) <= tolerated + rounding * rate / static_cast<double>(last)))
    fail(file, times, last,
         fmt::format("times at a mean interval of {:.6g} s; expected {:.6g} s within 2 %, by the sampling "
                     "rate of {:.6g} Hz",
                     mean, 1 / rate, rate));
}

/// The instants (N) [s].
Eigen::VectorXd instants(const std::string& file, const PrintedTimes& times, double to_seconds,
                         const std::optional<double>& rate, Eigen::Index size) {
  if (rate) {
    if (!times.values.empty()) check_rate(file, times, to_seconds, *rate);
    const double start = times.values.empty() ? 0 : times.values[0] * to_seconds;
    return start + Eigen::ArrayXd::LinSpaced(size, 0, static_cast<double>(size - 1)) / *rate;
  }
  if (const auto fault = find_sampling_fault(times.values, times.precision))
    fail(file, times, fault->sample, fault->message);
  return Eigen::Map<const Eigen::VectorXd>(times.values.data(), size) * to_seconds;
}

/// How finely the instants were printed [s]; 0 where coarser than half of their interval, which the stamps
/// then are multiples of.
double resolution(const PrintedTimes& times, double to_seconds, const Record& record) {
  const double printed = to_seconds * std::max(times.precision.resolution(times.values.front()),
                                               times.precision.resolution(times.values.back()));
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

}  // namespace

Record read_record(const std::filesystem::path& file, const RecordFormat& format) {
  const std::string name = file.string(), content = read_text(file, "a record of numbers in columns");
  DelimitedText text(name, content, format.separator, format.header_lines);
  const RecordColumns columns = find_columns(text, format);

  PrintedTimes times;
  std::vector<double> samples;
  while (text.next()) {
    if (columns.time) times.add(text, columns.time->index);
    for (const RecordColumn& column : columns.channels)
      samples.push_back(text.number(column.index) * column.factor);
  }
  const auto channels = static_cast<Eigen::Index>(columns.channels.size());
  const Eigen::Index size = static_cast<Eigen::Index>(samples.size()) / channels;
  if (size < 2) throw InputError(text.row_place(), "one row of numbers; expected at least two");

  Record record;
  record.time = instants(name, times, columns.time ? columns.time->factor : 1, format.sampling_rate, size);
  record.samples = Eigen::Map<const Eigen::MatrixXd>(samples.data(), channels, size);
  if (columns.time && !format.sampling_rate)
    record.time_resolution = resolution(times, columns.time->factor, record);
  for (const RecordColumn& column : columns.channels) record.channels.push_back(column.channel);
  return format.window ? cut(record, format, name) : record;
}

}  // namespace beamid::experiments
