#include "experiments/record/record_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <regex>

#include "experiments/record/inspect/defects.hpp"
#include "experiments/record/recognised_column.hpp"
#include "experiments/record/stamps.hpp"
#include "experiments/record/units.hpp"
#include "experiments/signal/onsets.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

// @param quantity that is stated; absent: time
void compare_statement(const std::optional<Quantity>& quantity, double factor, std::size_t index,
                       RecordTable& table) {
  const std::string header = column_name_of(table, index);
  const auto meaning = parse_column_name(header);
  if (!meaning) return;
  const auto unit_of = [](const std::optional<Quantity>& one) {
    return std::string(one ? si_unit(*one) : "s");
  };
  const std::string stated = fmt::format("Column {} is named '{}' and stated as {}", index + 1, header,
                                         quantity ? to_string(*quantity) : "time");
  if (unit_of(meaning->quantity) != unit_of(quantity))
    table.warnings.push_back(stated + ", which is another quantity: is it the column that was meant?");
  else if (std::abs(meaning->factor - factor) > 1e-9 * std::abs(factor))
    table.warnings.push_back(
        fmt::format("{} in another unit, {:.6g} times that of its name.", stated, factor / meaning->factor));
}

RecordColumn find_column(RecordTable& table, const ColumnDescription& wanted) {
  RecordColumn column{find_index(table, wanted),
                      wanted.factor,
                      {wanted.quantity, wanted.name, wanted.position, wanted.distance, wanted.place,
                       wanted.noise * wanted.factor}};
  if (!wanted.stated) {
    auto meaning = stated_meaning(table, column.index);
    if (const auto named = recognised(table, column.index); !meaning && table.by_people && named &&
                                                            named->kind == RecognisedColumn::Kind::signal &&
                                                            named->states_quantity)
      meaning = ColumnMeaning{named->quantity, "", named->factor};
    if (!meaning || !meaning->quantity)
      throw InputError(
          Place{table.file, table.header_line, 0},
          fmt::format(
              "column {} does not state what it measures, and in which unit; expected "
              "--quantity acceleration --unit g, or the like, beside --column; in [record] a quantity "
              "and its unit",
              wanted.name.empty() ? std::to_string(wanted.number) : "'" + wanted.name + "'"));
    column.channel.quantity = *meaning->quantity, column.factor = meaning->factor;
  }
  if (wanted.stated) compare_with_header(wanted, column.index, table);
  if (column.channel.name.empty()) column.channel.name = column_name_of(table, column.index);
  if (column.channel.name.empty()) column.channel.name = to_string(column.channel.quantity);
  return column;
}

// Stamps that run at another rate than the text above them states.
// @throws InputError where the unit of times may be the reason, or nothing names them as times
void compare_with_stated_rate(RecordTable& table, const RecordColumns& columns) {
  if (!columns.time || columns.time->index == table.time || !table.stated_rate) return;
  const double step = mean_step(table.columns[columns.time->index]) * columns.time->factor,
               ratio = step * *table.stated_rate;
  constexpr double tolerated = 0.02;
  const bool bare = table.names.empty() && std::abs(ratio - 1.0) > tolerated;
  if (step > 0.0 && (bare || std::abs(ratio / 1000.0 - 1.0) < tolerated))
    throw InputError(
        {table.file, table.header_line, 0},
        fmt::format(
            "column {} runs at {:.6g} Hz in its unit, and the file states {:.6g} Hz; expected the unit "
            "of its times: --time {}:ms or --time {}:s",
            columns.time->index + 1, 1.0 / step, *table.stated_rate, columns.time->index + 1,
            columns.time->index + 1));
  if (step > 0.0 && std::abs(ratio - 1.0) > tolerated && rises(table.columns[columns.time->index]))
    table.warnings.push_back(
        fmt::format("The file states {:.6g} Hz, and its stamps run at {:.6g} Hz: the stamps are taken.",
                    *table.stated_rate, 1.0 / step));
}

}  // namespace

std::string column_name_of(const RecordTable& table, std::size_t index) {
  return index < table.names.size() ? table.names[index] : "";
}

std::optional<RecognisedColumn> recognised(const RecordTable& table, std::size_t index) {
  return recognise_column(column_name_of(table, index), index < table.units.size() ? table.units[index] : "");
}

std::optional<ColumnMeaning> stated_meaning(const RecordTable& table, std::size_t index) {
  if (table.time == index) return ColumnMeaning{std::nullopt, "", 1};
  auto meaning = parse_column_name(column_name_of(table, index));
  if (index >= table.units.size()) return meaning;
  const auto unit = stated_unit(table.units[index]);
  if (!unit) return meaning;
  if (!meaning) return ColumnMeaning{unit->quantity, column_name_of(table, index), unit->factor};
  const bool imposed = meaning->quantity == Quantity::base_acceleration ||
                       meaning->quantity == Quantity::support_acceleration;  // in units of an acceleration
  if (unit->quantity != (imposed ? Quantity::acceleration : meaning->quantity) ||
      unit->factor != meaning->factor)
    throw InputError({table.file, table.header_line},
                     fmt::format("'{}' has the unit '{}'; expected the one of its name", table.names[index],
                                 table.units[index]));
  return meaning;
}

void compare_with_header(const ColumnDescription& wanted, std::size_t index, RecordTable& table) {
  compare_statement(wanted.quantity, wanted.factor, index, table);
}

std::size_t find_index(const RecordTable& table, const ColumnDescription& wanted) {
  const std::vector<std::string>& names = table.names;
  if (wanted.name.empty()) {
    const auto index = static_cast<std::size_t>(wanted.number) - 1;
    if (index >= table.width())
      throw InputError(table.row_place(0), fmt::format("{}; expected at least {}, the column requested",
                                                       count_of_columns(table.width()), wanted.number));
    return index;
  }
  if (names.empty())
    throw InputError({table.file, 0, 0},
                     fmt::format("no header; expected one that names the column '{}'", wanted.name));
  const Place header{table.file, table.header_line, 1};
  const auto match = std::find(names.begin(), names.end(), wanted.name);
  if (match == names.end()) {
    const auto meant = nearest(wanted.name, names);
    throw InputError(header, fmt::format("no column '{}'{}; the {}: {}", wanted.name,
                                         meant ? "; did you mean '" + *meant + "'?" : "",
                                         table.cell ? "header names" : "file holds", joined(names)));
  }
  if (std::find(match + 1, names.end(), wanted.name) != names.end())
    throw InputError(header, fmt::format("several columns '{}'; expected one, or its number", wanted.name));
  const auto index = static_cast<std::size_t>(match - names.begin());
  if (index >= table.width())
    throw InputError(table.row_place(0),
                     fmt::format("{}; expected {} for the column '{}'", count_of_columns(table.width()),
                                 index + 1, wanted.name));
  return index;
}

namespace {

// "time diff in ms", "delta t (s)": intervals, of which the times are the sum.
bool sum_intervals(const RecordTable& table, std::size_t index, std::vector<double>& values) {
  static const std::regex intervals(R"((^|[^a-z])(diff\w*|delta|dt|interval)([^a-z]|$))");
  const auto found = recognised(table, index);
  if (!found || found->kind != RecognisedColumn::Kind::time || rises(values) ||
      !std::regex_search(folded(column_name_of(table, index)), intervals) ||
      std::ranges::any_of(values, [](double value) { return !(value >= 0.0); }))
    return false;
  std::partial_sum(values.begin(), values.end(), values.begin());
  return true;
}

}  // namespace

namespace {

// Without the cells at its end that hold nothing.
std::vector<double> to_its_end(const std::vector<double>& values) {
  std::size_t count = values.size();
  while (count > 0 && !std::isfinite(values[count - 1])) --count;
  return {values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count)};
}

}  // namespace

void require_one_clock(const RecordTable& table, const RecordColumn& time, bool is_sure, std::size_t index,
                       const RecognisedColumn& other) {
  constexpr double alike = 0.02, in_other_units = 50.0;
  const std::vector<double> one = to_its_end(table.columns[time.index]),
                            two = to_its_end(table.columns[index]);
  if (!rises(one) || !rises(two)) return;
  const auto refuse = [&](const std::string& how) {
    throw InputError({table.file, table.header_line, 0},
                     fmt::format("columns {0} and {1} are times of two clocks, {2}; expected the channels of "
                                 "one: --time {0}:s --column N, or --time {1}:s --column N",
                                 time.index + 1, index + 1, how));
  };
  const std::size_t longer = std::max(one.size(), two.size()), shorter = std::min(one.size(), two.size());
  if (longer > shorter + 1 + longer / 1000)
    refuse(fmt::format("the first over {} rows, the second over {}", one.size(), two.size()));
  if (!is_sure && other.states_unit) return;
  double ratio = mean_step(two) / mean_step(one);
  if (is_sure && other.states_unit)
    ratio *= other.factor / time.factor;
  else if (is_sure != other.states_unit || std::max(ratio, 1.0 / ratio) > in_other_units)
    return;
  if (std::abs(ratio - 1.0) >= alike)
    refuse(fmt::format("the second at {:.4g} times the rate of the first", 1.0 / ratio));
}

bool names_motion(const RecordTable& table) {
  for (std::size_t index = 0; index < std::min(table.names.size(), table.width()); ++index)
    if (const auto found = recognised(table, index); found && found->kind == RecognisedColumn::Kind::signal &&
                                                     found->states_quantity &&
                                                     found->quantity != Quantity::force)
      return true;
  return false;
}

void leave_out_repeated(RecordTable& table, const RecordColumns& columns) {
  constexpr double few = 0.2;  // of the rows
  if (!columns.time) return;
  const std::vector<double>& times = table.columns[columns.time->index];
  std::vector<bool> kept(table.rows(), true);
  std::vector<std::size_t> lines;
  bool same = true;
  for (std::size_t row = 1; row < table.rows(); ++row) {
    if (times[row] != times[row - 1]) continue;
    same = same && std::ranges::all_of(columns.channels, [&](const RecordColumn& one) {
             return table.columns[one.index][row] == table.columns[one.index][row - 1];
           });
    kept[row] = false;
    lines.push_back(table.line_of(row));
  }
  if (lines.empty() || static_cast<double>(lines.size()) > few * static_cast<double>(table.rows())) return;
  if (!same) {  // stamps of several samples, or printed more coarsely than samples follow each other
    const double step = mean_step(times),
                 printed = table.precision[columns.time->index].resolution(times.back());
    double off = 0.0;
    for (std::size_t row = 1; row < table.rows(); ++row) {
      if (times[row] < times[row - 1]) return;
      off = std::max(off, std::abs(times[row] - times[0] - step * static_cast<double>(row)));
    }
    if (off < 2.0 * printed + step) return;
  }
  table.remarks.push_back(
      skipped_text(lines, same ? "repeats the line before it" : "has the stamp of the line before it"));
  table.keep(kept);
}

void keep_updates(RecordTable& table, const RecordColumns& columns) {
  constexpr std::size_t fewest = 16, longest = 64;
  constexpr double nearly_all = 0.95;
  std::size_t repeats = 0;
  for (const RecordColumn& column : columns.channels) {
    const std::vector<double>& values = table.columns[column.index];
    std::vector<std::size_t> runs;
    std::size_t begin = 0;
    for (std::size_t row = 1; row < values.size(); ++row)
      if (values[row] != values[row - 1]) {
        if (begin > 0) runs.push_back(row - begin);
        begin = row;
      }
    if (runs.size() < fewest) return;
    std::ranges::nth_element(runs, runs.begin() + std::ssize(runs) / 2);
    const std::size_t usual = runs[runs.size() / 2];
    const auto regular = std::ranges::count_if(runs, [&](std::size_t run) { return run % usual == 0; });
    if (usual < 2 || usual > longest || (repeats != 0 && usual != repeats) ||
        static_cast<double>(regular) < nearly_all * static_cast<double>(runs.size()))
      return;
    repeats = usual;
  }
  if (repeats == 0) return;
  const std::vector<double>& first = table.columns[columns.channels.front().index];
  std::vector<bool> kept(table.rows(), false);
  std::size_t last = 0;
  for (std::size_t row = 1; row < kept.size(); ++row)
    if (first[row] != first[row - 1] || row == last + repeats) kept[row] = true, last = row;
  table.keep(kept);
  table.remarks.push_back(fmt::format(
      "The readings of each channel are repeated over {0} rows: one row of {0} is kept.", repeats));
}

namespace {

constexpr double fastest = 5e-6;  // [s], of 200 kHz

}  // namespace

bool is_plausible(double step, double taken) {
  const bool by_size = taken != 1.0, of_days = taken == 86400.0;
  return !(step > 0.0) || of_days || (step * taken < (by_size ? 0.5 : 0.1) && step * taken > fastest);
}

// Times of no stated unit whose rate would be below 10 Hz or above 200 kHz, were they in units of `taken`
// [s]: most are in another.
// @throws InputError the question
void require_plausible_step(const RecordTable& table, std::size_t index, double taken) {
  constexpr double largest = 20.0;  // [s]
  const double step = mean_step(table.columns[index]);
  constexpr double alike = 0.02;
  const bool as_stated = table.stated_rate && std::abs(step * taken * *table.stated_rate - 1.0) < alike;
  if (is_plausible(step, taken) || as_stated) return;
  const std::string name = column_name_of(table, index);
  std::string answers;
  for (const auto& [unit, factor] : {std::pair{"ns", 1e-9},
                                     {"us", 1e-6},
                                     {"ms", 1e-3},
                                     {"s", 1.0},
                                     {"min", 60.0},
                                     {"h", 3600.0},
                                     {"d", 86400.0}}) {
    const double seconds = step * factor;
    if (seconds < largest && seconds > fastest)
      answers += fmt::format("{}--time {}:{} ({:.6g} Hz)", answers.empty() ? "" : ", ", index + 1, unit,
                             1.0 / seconds);
  }
  throw InputError({table.file, table.header_line, 0},
                   fmt::format("column {}{} rises by {:.6g} from row to row and states no unit; expected the "
                               "unit of its times: {}{}record.time in the configuration",
                               index + 1, name.empty() ? "" : " '" + name + "'", step, answers,
                               answers.empty() ? "--rate HZ, or " : ", or "));
}

RecordColumns find_columns(RecordTable& table, const RecordFormat& format) {
  RecordColumns columns;
  // Times that are stated elsewhere need no column.
  const bool stamped = format.time || format.sampling_rate;
  for (std::size_t index = 0; table.by_people && index < table.width(); ++index)
    if (const auto range = go_on_past_range(table.columns[index]))
      table.remarks.push_back(fmt::format("Column {} starts again after {}: it goes on from there.",
                                          index + 1,
                                          *range > 65536.0 ? "2^32 counts"
                                          : *range > 60.0  ? "2^16 counts"
                                                           : "60"));
    else if (sum_intervals(table, index, table.columns[index]))
      table.remarks.push_back(fmt::format("Column {} holds intervals: times are their sum.", index + 1));
  if (format.channels.empty()) columns = columns_of_header(table, stamped);
  for (const ColumnDescription& wanted : format.channels)
    columns.channels.push_back(find_column(table, wanted));
  if (format.time) {
    columns.time = {find_index(table, *format.time), format.time->factor, {}};
    if (format.channels.empty())
      std::erase_if(columns.channels, [&](const auto& one) { return one.index == columns.time->index; });
    compare_statement({}, format.time->factor, columns.time->index, table);
  }
  if (!columns.time && table.time) columns.time = RecordColumn{*table.time, 1, {}};
  for (std::size_t index = 0; !columns.time && index < std::min(table.names.size(), table.width()); ++index)
    if (const auto meaning = stated_meaning(table, index); meaning && !meaning->quantity)
      columns.time = RecordColumn{index, meaning->factor, {}};
  if (!columns.time && !format.channels.empty() && table.by_people && !table.clock && !format.sampling_rate)
    find_times(table, columns);
  if (!stamped) compare_with_stated_rate(table, columns);
  if (!columns.time && !table.clock && !format.sampling_rate && table.stated_rate) {
    table.clock = Clock{0.0, 1.0 / *table.stated_rate};
    table.remarks.push_back(fmt::format(
        "The file states {:.6g} Hz above its columns: samples are taken at that rate.", *table.stated_rate));
  }
  if (!columns.time && !table.clock && !format.sampling_rate &&
      (columns.counted || (table.width() == 1 && table.names.empty())))
    throw InputError({table.file, 0, 0},
                     columns.counted
                         ? fmt::format("Column {} counts samples; expected the sampling rate: --rate HZ, or "
                                       "record.sampling_rate_hz in the configuration",
                                       *columns.counted + 1)
                         : std::string("One column, and no times; expected the sampling rate: --rate HZ, or "
                                       "record.sampling_rate_hz in the configuration"));
  if (!columns.time && !table.clock && !format.sampling_rate)
    throw InputError({table.file, 0, 0},
                     "no column of time; expected the sampling rate, --rate HZ, or the column, --time "
                     "COLUMN:UNIT (record.sampling_rate_hz, record.time in the configuration)");
  return columns;
}

namespace {

// Whether a column is the root of the sum of squares of two or three others, in a row: what phones add. Under
// a name of a sum, the constant that a calibration takes off may be missing.
bool is_magnitude(const RecordTable& table, const std::vector<RecordColumn>& channels, std::size_t which) {
  constexpr double tolerated = 1e-4;  // of squares
  static const std::regex sum(R"(.*(calibrated|total|abs|magn|result|norm).*)");
  const std::vector<double>& values = table.columns[channels[which].index];
  const bool shifted = std::regex_match(folded(channels[which].channel.name), sum);
  if (!shifted && std::ranges::any_of(values, [](double value) { return value < 0.0; })) return false;
  for (std::size_t first = 0; first + 1 < channels.size(); ++first)
    for (const std::size_t count : {2u, 3u}) {
      if (first + count > channels.size() || (which >= first && which < first + count)) continue;
      double left = 0.0, all = 0.0, rest = 0.0, mean = 0.0, rows = 0.0;
      for (std::size_t row = 0; row < values.size(); ++row) {
        double square = 0.0;
        for (std::size_t i = first; i < first + count; ++i)
          square += std::pow(table.columns[channels[i].index][row], 2);
        if (!std::isfinite(square + values[row])) continue;
        const double difference = values[row] - std::sqrt(square);
        left += difference * difference, all += values[row] * values[row];
        rest += difference, mean += values[row], rows += 1.0;
      }
      if (all > 0.0 && left < tolerated * all) return true;
      if (shifted && count == 3 && left - rest * rest / rows < tolerated * (all - mean * mean / rows))
        return true;
    }
  return false;
}

Eigen::VectorXd finite_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

void leave_out_magnitudes(RecordTable& table, RecordColumns& columns) {
  std::string magnitudes;
  for (std::size_t k = columns.channels.size(); k-- > 0 && columns.channels.size() > 2;)
    if (is_magnitude(table, columns.channels, k)) {
      magnitudes += (magnitudes.empty() ? "'" : ", '") + columns.channels[k].channel.name + "'";
      columns.channels.erase(columns.channels.begin() + static_cast<std::ptrdiff_t>(k));
    }
  if (!magnitudes.empty())
    table.remarks.push_back(
        "The magnitude of other columns, which has no frequency of its own, omitted: " + magnitudes + ".");
}

void leave_out_still(RecordTable& table, RecordColumns& columns) {
  constexpr double longest = 0.01, shorter = 0.1, other_side = 0.2;  // of rows, of another's, of the peak
  constexpr double fewest = 3.0;                                     // rows: fewer may be a spike
  const bool any_assumed =
      columns.channels.size() > 1 && std::ranges::any_of(columns.channels, &RecordColumn::assumed);
  std::vector<RecordColumn> alive;
  std::vector<Excursions> excursions;
  std::string dead, pulses;
  double most = 0.0;
  for (const RecordColumn& column : columns.channels) {
    const std::vector<double>& values = table.columns[column.index];
    if (is_dead(values)) {
      dead += (dead.empty() ? "'" : ", '") + column.channel.name + "'";
      continue;
    }
    alive.push_back(column);
    excursions.push_back(any_assumed ? excursions_of(finite_of(values)) : Excursions{});
    most = std::max(most, excursions.back().share);
  }
  if (alive.empty()) return;
  columns.channels.clear();
  for (std::size_t k = 0; k < alive.size(); ++k) {
    const auto& [share, opposite] = excursions[k];
    if (alive[k].assumed && share * static_cast<double>(table.rows()) >= fewest && opposite < other_side &&
        share < std::min(shorter * most, longest))
      pulses += (pulses.empty() ? "'" : ", '") + alive[k].channel.name + "'";
    else
      columns.channels.push_back(std::move(alive[k]));
  }
  if (!dead.empty()) table.remarks.push_back("Without any motion, omitted: " + dead + ".");
  if (!pulses.empty())
    table.remarks.push_back("Pulses to one side without a vibration, as of a hammer's force, omitted: " +
                            pulses + ". As a force: --column N --quantity force --unit N.");
}

}  // namespace beamid::experiments
