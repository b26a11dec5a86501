#include "experiments/record/record_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/record/recognised_column.hpp"
#include "experiments/record/stamps.hpp"
#include "experiments/record/units.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

constexpr const char* in_configuration = "record.channels in the configuration";

std::string column_name_of(const RecordTable& table, std::size_t index) {
  return index < table.names.size() ? table.names[index] : "";
}

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
    const auto meaning = stated_meaning(table, column.index);
    if (!meaning || !meaning->quantity)
      throw InputError(
          Place{table.file, table.header_line, 0},
          fmt::format("column {} does not state what it measures, and in which unit; expected that as text "
                      "beside it: a quantity and its unit",
                      wanted.name.empty() ? std::to_string(wanted.number) : "'" + wanted.name + "'"));
    column.channel.quantity = *meaning->quantity, column.factor = meaning->factor;
  }
  if (wanted.stated) compare_with_header(wanted, column.index, table);
  if (column.channel.name.empty()) column.channel.name = column_name_of(table, column.index);
  if (column.channel.name.empty()) column.channel.name = to_string(column.channel.quantity);
  return column;
}

// Fewer than half of its cells hold numbers. @throws InputError at a cell that begins as a number does: a
// column of such is one that was parted wrongly, or of numbers in another form.
bool holds_words(const RecordTable& table, std::size_t index) {
  const std::vector<double>& values = table.columns[index];
  const auto numbers = std::ranges::count_if(values, [](double value) { return std::isfinite(value); });
  if (2 * static_cast<std::size_t>(numbers) >= values.size()) return false;
  for (std::size_t row = 0; table.cell && row < values.size(); ++row) {
    if (std::isfinite(values[row])) continue;
    const std::string text = table.cell(row, index).text;
    const std::size_t first = text.find_first_not_of("\"'+-.,");
    if (first != text.npos && text[first] >= '0' && text[first] <= '9') throw table.fault(row, index);
  }
  return true;
}

std::string unit_of_time(double factor) {
  return factor == 1.0       ? "s"
         : factor == 1e-3    ? "ms"
         : factor == 1e-6    ? "us"
         : factor == 1e-9    ? "ns"
         : factor == 60.0    ? "min"
         : factor == 86400.0 ? "days"
                             : fmt::format("{:g} s", factor);
}

// "column 2 is", "columns 2 to 4 are".
std::string numbers_of(const std::vector<RecordColumn>& columns) {
  std::string list;
  for (const RecordColumn& column : columns)
    list += fmt::format("{}{}", list.empty() ? "" : ", ", column.index + 1);
  return fmt::format("column{} {} {}", columns.size() == 1 ? "" : "s", list,
                     columns.size() == 1 ? "is" : "are");
}

// Times of no stated unit at steps of half a second or more, were they seconds: most are milliseconds.
// @throws InputError the question
void require_plausible_step(const RecordTable& table, std::size_t index) {
  constexpr double slowest = 0.5;
  const double step = mean_step(table.columns[index]);
  if (!(step >= slowest)) return;
  const std::string name = column_name_of(table, index);
  throw InputError(
      {table.file, table.header_line, 0},
      fmt::format("column {}{} rises by {:.6g} from row to row and states no unit; expected the unit of its "
                  "times: --time {}:ms ({:.6g} Hz), --time {}:us ({:.6g} Hz) or --time {}:s ({:.6g} Hz), or "
                  "record.time in the configuration",
                  index + 1, name.empty() ? "" : " '" + name + "'", step, index + 1, 1e3 / step, index + 1,
                  1e6 / step, index + 1, 1.0 / step));
}

// Of columns whose names are not this project's own, what was recognised.
class Recognition {
 public:
  // @returns whether the column means something, if only that it is no channel
  bool take(RecordTable& table, std::size_t index, RecordColumns& columns) {
    const std::string& name = table.names[index];
    const auto found = recognise_column(name, index < table.units.size() ? table.units[index] : "");
    if (!found) return false;
    const auto add = [&](std::string& list) {
      list += (list.empty() ? "" : ", ") +
              (name.empty() ? fmt::format("column {}", index + 1) : "'" + name + "'");
    };
    const std::vector<double>& values = table.columns[index];
    if (holds_words(table, index)) {
      add(words_);
      if (!first_words_) first_words_ = index;
      return true;
    }
    if (name.empty()) {  // the index of a table
      if (counts_samples(values))
        counted_ = counted_.value_or(index);
      else if (index == 0 && rises(values))
        unnamed_ = index;
      else
        add(other_);
      return true;
    }
    if (index == 0 && found->kind == RecognisedColumn::Kind::signal && !found->states_quantity &&
        !found->states_unit && runs_evenly(values)) {  // no motion does
      if (counts_samples(values))
        counted_ = counted_.value_or(index);
      else
        unnamed_ = index;
      return true;
    }
    switch (found->kind) {
      case RecognisedColumn::Kind::count:
        if (!counted_) counted_ = index;
        break;
      case RecognisedColumn::Kind::other:
        add(other_);
        break;
      case RecognisedColumn::Kind::time:
        if (columns.time || table.time) {
          add(other_);
        } else if (!found->states_unit && counts_samples(table.columns[index])) {
          counted_ = index;
        } else {
          const bool certain = found->states_unit && mean_step(table.columns[index]) >= found->least_step;
          take_stamps(table, index, certain ? std::optional(found->factor) : std::nullopt, columns);
        }
        break;
      case RecognisedColumn::Kind::signal: {
        columns.channels.push_back({index, found->factor, {found->quantity, name}});
        columns.recognised = true;
        const bool as_it_is = !found->states_unit;
        read_ += fmt::format("{}'{}' as {}{}", read_.empty() ? "" : ", ", name, to_string(found->quantity),
                             as_it_is ? ", its unit taken for " + std::string(si_unit(found->quantity)) : "");
      }
    }
    return true;
  }

  // Stamps alone, where channels are stated.
  void take_time(RecordTable& table, RecordColumns& columns, bool stamped) {
    for (std::size_t index = 0; index < std::min(table.names.size(), table.width()); ++index) {
      const auto found =
          recognise_column(table.names[index], index < table.units.size() ? table.units[index] : "");
      if (found && (found->kind == RecognisedColumn::Kind::time ||
                    found->kind == RecognisedColumn::Kind::count || (index == 0 && table.names[0].empty())))
        take(table, index, columns);
    }
    other_.clear(), words_.clear();
    report(table, columns, stamped);
  }

  // Says it in one line, and asks the one question that is left.
  void report(RecordTable& table, RecordColumns& columns, bool stamped) {
    if (columns.channels.empty() && first_words_) {
      std::size_t row = 0;
      while (std::isfinite(table.columns[*first_words_][row])) ++row;
      throw table.fault(row, *first_words_);
    }
    if (unnamed_ && !columns.time && !table.time && !stamped) take_stamps(table, *unnamed_, {}, columns);
    const std::string stamps = table.time && table.by_people && !column_name_of(table, *table.time).empty()
                                   ? "'" + column_name_of(table, *table.time) + "' as dates or times of day, "
                                   : "";
    if (!read_.empty()) table.remarks.push_back("Read: " + stamps + read_ + ".");
    if (!words_.empty()) table.remarks.push_back("Text in place of numbers, omitted: " + words_ + ".");
    if (!other_.empty()) table.remarks.push_back("No channels of motion, omitted: " + other_ + ".");
    if (!columns.time && !table.time) columns.counted = counted_;
    drop_first_zeros(table, columns);
  }

 private:
  std::string read_, other_, words_;
  std::optional<std::size_t> counted_, unnamed_, first_words_;

  // @param factor to seconds, where the file states it
  void take_stamps(const RecordTable& table, std::size_t index, std::optional<double> factor,
                   RecordColumns& columns) {
    if (!factor) {
      factor = seconds_of_epoch(table.columns[index]);
      if (*factor == 1.0) require_plausible_step(table, index);
    }
    columns.time = RecordColumn{index, *factor, {}};
    const std::string name = column_name_of(table, index);
    read_ += fmt::format("{}{} as time in {}", read_.empty() ? "" : ", ",
                         name.empty() ? fmt::format("column {}", index + 1) : "'" + name + "'",
                         unit_of_time(*factor));
  }

  // A logger's first sample, before its sensor has answered.
  static void drop_first_zeros(RecordTable& table, const RecordColumns& columns) {
    constexpr std::size_t enough = 16;
    if (columns.channels.empty() || table.rows() < enough) return;
    for (const RecordColumn& column : columns.channels)
      if (table.columns[column.index][0] != 0.0 || table.columns[column.index][1] == 0.0) return;
    if (columns.channels.size() < 2 && table.width() < 3) return;
    std::vector<bool> kept(table.rows(), true);
    kept[0] = false;
    table.keep(kept);
    table.remarks.emplace_back("The first sample, zero in every channel, is omitted.");
  }
};

// The first column that rises is time.
// @param columns of which `time` or `counted` is set
// @returns the first column behind it
std::size_t take_first_rising(const RecordTable& table, bool stamped, RecordColumns& columns) {
  std::size_t first = 0;
  while (first + 1 < table.width() && holds_words(table, first)) ++first;
  if (table.width() <= first + 1 || table.time || !rises(table.columns[first])) return first;
  if (counts_samples(table.columns[first])) {
    columns.counted = first;
    if (table.width() > first + 2 && runs_evenly(table.columns[first + 1]) &&
        !counts_samples(table.columns[first + 1]))
      ++first;  // counts, then times
  }
  if (columns.counted != first && !stamped) {
    const double unit = seconds_of_epoch(table.columns[first]);
    if (unit == 1.0) require_plausible_step(table, first);
    columns.time = RecordColumn{first, unit, {}};
    columns.counted = {};
  }
  return first + 1;
}

// The first column that rises is time, the rest are signals.
RecordColumns columns_without_header(RecordTable& table, bool stamped) {
  RecordColumns columns;
  columns.recognised = true;
  const std::size_t first = take_first_rising(table, stamped, columns);
  const auto never_moves = [](const std::vector<double>& values) {  // dates beside times of day
    return std::ranges::all_of(values, [&](double value) { return value == 0.0; });
  };
  for (std::size_t index = first; index < table.width(); ++index)
    if (table.time != index && !never_moves(table.columns[index]) && !holds_words(table, index))
      columns.channels.push_back({index, 1.0, {Quantity::acceleration, fmt::format("column_{}", index + 1)}});
  table.remarks.push_back(fmt::format(
      "No header: {}{} taken for acceleration in m/s2. Frequency and damping ratio do not depend on it.",
      columns.time ? fmt::format("column {} is taken for time in {}, ", columns.time->index + 1,
                                 unit_of_time(columns.time->factor))
                   : "",
      numbers_of(columns.channels)));
  return columns;
}

RecordColumns columns_of_header(RecordTable& table, bool stamped) {
  RecordColumns columns;
  const Place header{table.file, table.header_line, 0};
  if (table.names.empty() && table.by_people) return columns_without_header(table, stamped);
  if (table.names.size() != table.width())
    throw InputError(header,
                     fmt::format("a header of {} names for {}; expected one each, with its unit ({}), or {}",
                                 table.names.size(), count_of_columns(table.width()), known_column_names(),
                                 in_configuration));
  std::string unknown;
  Recognition recognition;
  for (std::size_t index = 0; index < table.width(); ++index) {
    if (table.time == index) continue;
    const auto meaning = stated_meaning(table, index);
    if (!meaning && table.by_people && recognition.take(table, index, columns)) continue;
    if (!meaning && table.units.empty())
      throw InputError(header, fmt::format("unknown column '{}'; expected names with units ({}), or {}",
                                           table.names[index], known_column_names(), in_configuration));
    if (!meaning)
      unknown +=
          fmt::format("{}'{}' [{}]", unknown.empty() ? "" : ", ", table.names[index], table.units[index]);
    else if (meaning->quantity)
      columns.channels.push_back(
          {index,
           meaning->factor,
           {*meaning->quantity, meaning->label.empty() ? to_string(*meaning->quantity) : meaning->label}});
    else if (columns.time)
      throw InputError(header, "two columns of time; expected one");
    else
      columns.time = RecordColumn{index, meaning->factor, {}};
  }
  recognition.report(table, columns, stamped);
  if (columns.channels.empty() && !unknown.empty())
    throw InputError(
        header, fmt::format("no unit states what is measured: {}; expected {}", unknown, in_configuration));
  if (columns.channels.empty()) throw InputError(header, "no column but time; expected a measured quantity");
  if (!unknown.empty())
    table.remarks.push_back(
        fmt::format("Omitted, as the unit does not determine the quantity: {}.", unknown));
  return columns;
}

}  // namespace

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

RecordColumns find_columns(RecordTable& table, const RecordFormat& format) {
  RecordColumns columns;
  // Times that are stated elsewhere need no column.
  const bool stamped = format.time || format.sampling_rate;
  if (format.channels.empty()) columns = columns_of_header(table, stamped);
  for (const ColumnDescription& wanted : format.channels)
    columns.channels.push_back(find_column(table, wanted));
  if (format.time) {
    columns.time = {find_index(table, *format.time), format.time->factor, {}};
    compare_statement({}, format.time->factor, columns.time->index, table);
  }
  if (!columns.time && table.time) columns.time = RecordColumn{*table.time, 1, {}};
  for (std::size_t index = 0; !columns.time && index < std::min(table.names.size(), table.width()); ++index)
    if (const auto meaning = stated_meaning(table, index); meaning && !meaning->quantity)
      columns.time = RecordColumn{index, meaning->factor, {}};
  if (!columns.time && !format.channels.empty() && table.by_people && !table.clock && !format.sampling_rate) {
    if (table.names.empty())
      take_first_rising(table, false, columns);
    else
      Recognition().take_time(table, columns, false);
  }
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

void leave_out_dead(RecordTable& table, RecordColumns& columns) {
  std::vector<RecordColumn> alive;
  std::string dead;
  for (const RecordColumn& column : columns.channels) {
    const std::vector<double>& values = table.columns[column.index];
    if (std::ranges::any_of(values, [&](double value) { return value != values.front(); }))
      alive.push_back(column);
    else
      dead += (dead.empty() ? "'" : ", '") + column.channel.name + "'";
  }
  if (alive.empty() || dead.empty()) return;
  columns.channels = std::move(alive);
  table.remarks.push_back("Without any motion, omitted: " + dead + ".");
}

}  // namespace beamid::experiments
