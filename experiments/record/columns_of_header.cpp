// What a file that nobody described says of its columns: by their names as people write them, or by their
// numbers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <tuple>
#include <utility>

#include "experiments/record/inspect/defects.hpp"
#include "experiments/record/record_columns.hpp"
#include "experiments/record/stamps.hpp"
#include "experiments/record/units.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {
namespace {

// Fewer than half of its cells hold numbers. @throws InputError at a cell that begins as a number does: a
// column of such is one that was parted wrongly, or of numbers in another form.
bool holds_words(const RecordTable& table, std::size_t index) {
  const std::vector<double>& values = table.columns[index];
  const auto numbers = std::ranges::count_if(values, [](double value) { return std::isfinite(value); });
  if (2 * static_cast<std::size_t>(numbers) >= values.size()) return false;
  for (std::size_t row = 0; table.cell && row < values.size(); ++row) {
    if (std::isfinite(values[row])) continue;
    const std::string text = table.cell(row, index).text;
    if (text.find(" / ") != text.npos) continue;  // "6 / 12": so many of so many
    const std::size_t first = text.find_first_not_of("\"'+-.,");
    if (first != text.npos && text[first] >= '0' && text[first] <= '9') throw table.fault(row, index);
  }
  return true;
}

// The unit that the lines above state. @throws InputError the question where they do not decide it
// (stated_unit.cpp)
std::pair<Quantity, double> certain_unit(const RecordTable& table) {
  if (!std::isnan(table.stated_unit->second) || table.warnings.empty()) return *table.stated_unit;
  const std::string& found = table.warnings.back();
  throw InputError({table.file, 0, 0}, fmt::format("{}; expected the unit of each channel: {}",
                                                   found.substr(0, found.size() - 1), in_configuration));
}

// "column 2 is", "columns 2 to 4 are".
std::string numbers_of(const std::vector<RecordColumn>& columns) {
  std::string list;
  for (const RecordColumn& column : columns)
    list += fmt::format("{}{}", list.empty() ? "" : ", ", column.index + 1);
  return fmt::format("column{} {} {}", columns.size() == 1 ? "" : "s", list,
                     columns.size() == 1 ? "is" : "are");
}

// In one unit, so that shapes of channels are.
double size_of_reading(std::string_view unit) {
  return unit == "mV" ? 1e-3 : unit == "uV" ? 1e-6 : 1.0;
}

bool holds_stamps(const RecordTable& table, std::size_t index) {
  return table.cell && table.rows() > 0 && parse_stamp(unquoted(table.cell(0, index).text));
}

// Of several columns of times the first that rises: "Date", "Time", "Elapsed (s)".
std::optional<std::size_t> rising_time(const RecordTable& table) {
  for (std::size_t index = 0; index < std::min(table.names.size(), table.width()); ++index) {
    const auto found = recognised(table, index);
    const bool time = table.time == index || (found && found->kind == RecognisedColumn::Kind::time) ||
                      holds_stamps(table, index);
    if (time && rises(table.columns[index]) &&
        !(found && !found->states_unit && counts_samples(table.columns[index])))
      return index;
  }
  return {};
}

// "x", "N", "up", "tip", "ch3": of columns whose quantity others state.
bool is_direction_or_place(const std::string& name) {
  static const std::regex form(
      "[a-oq-z][0-9]*|ns|ew|ud|up|north|south|east|west|vert.*|.*(tip|top|mid|base|floor).*|(ch|kanal|sensor)"
      ".*");
  return std::regex_match(folded(name), form);
}

// "D0", "D0-D7", "Digital 3", with the states of lines, no reading.
bool is_digital(const std::string& name, const std::vector<double>& values) {
  static const std::regex form(R"((d|digital|logic|dio|dig|pod|bit)[ _-]?[0-9]+( ?[-:] ?d?[0-9]+)?)"),
      several(".*[0-9] ?[-:] ?d?[0-9]+");
  const std::string text = folded(name);
  const double most = std::regex_match(text, several) ? 65535.0 : 1.0;
  return std::regex_match(text, form) && std::ranges::all_of(values, [&](double value) {
           return std::isnan(value) || (value >= 0.0 && value <= most && value == std::floor(value));
         });
}

// Of columns whose names are not this project's own, what was recognised.
class Recognition {
 public:
  // @param stamped whether times are stated elsewhere
  Recognition(RecordTable& table, bool stamped)
      : rising_(rising_time(table)), stamped_(stamped), states_motion_(names_motion(table)) {
    if (!table.time || !rising_ || table.time == rising_ || rises(table.columns[*table.time])) return;
    if (holds_stamps(table, *rising_))
      table.time = rising_;
    else
      table.time.reset();
  }

  // @returns whether the column means something, if only that it is no channel
  bool take(RecordTable& table, std::size_t index, RecordColumns& columns) {
    const std::string& name = table.names[index];
    auto found = recognised(table, index);
    if (!found) return false;
    const auto letters = [](const std::string& written) {  // "g_x", "GX" and "gx_raw" as "gx"
      std::string text = folded(written);
      if (text.ends_with("raw")) text.resize(text.size() - 3);
      std::erase(text, '_');
      return text;
    };
    const auto named = [&](const char* one) {
      return std::ranges::any_of(table.names, [&](const auto& other) {
        const std::string brief = letters(other);
        const std::size_t end = std::string_view(one).size();
        return brief.starts_with(one) && (brief.size() == end || brief[end] == '(' || brief[end] == ' ');
      });
    };
    if (const std::string brief = letters(name);
        brief.size() == 2 && std::string_view("gmwh").find(brief[0]) != std::string_view::npos &&
        std::string_view("xyz").find(brief[1]) != std::string_view::npos && (named("ax") || named("ay")))
      found->kind = RecognisedColumn::Kind::other;  // of a gyroscope or a compass
    if (name.ends_with("(N)") && std::ranges::any_of(table.names, [](const std::string& other) {
          return other.ends_with("(txt)");  // kinds of values: text, numbers
        }))
      found->kind = RecognisedColumn::Kind::other;
    if (const std::string text = folded(name);
        states_motion_ && text.find("gravity") != text.npos && text.find("acc") == text.npos)
      found->kind = RecognisedColumn::Kind::other;                 // of a telephone, beside accelerations
    if ((name == "U" || name == "u") && named("n") && named("e"))  // up
      found->quantity = Quantity::acceleration, found->states_quantity = false;
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
    if (found->kind == RecognisedColumn::Kind::time && !found->states_unit && swings(values))
      found->kind = RecognisedColumn::Kind::signal, found->states_quantity = false;
    if (found->kind == RecognisedColumn::Kind::signal &&
        (is_digital(name, values) || (named("sdn") && (name == "Q" || name == "ns"))))
      found->kind = RecognisedColumn::Kind::other;
    if (index > 0 && table.width() > 2 && found->kind == RecognisedColumn::Kind::signal &&
        counts_rows(values))
      found->kind = RecognisedColumn::Kind::count;
    const bool of_matrix = name.ends_with("(:,1)") || name.ends_with("(1,:)") || name.ends_with("[:,0]");
    const bool unstated = found->kind == RecognisedColumn::Kind::signal && !found->states_unit;
    constexpr std::size_t long_enough = 100;
    if (index > 0 && unstated && values.size() > long_enough && runs_evenly(values))
      found->kind = RecognisedColumn::Kind::other;  // an axis of something else
    if (index == 0 && unstated && (!found->states_quantity || of_matrix) &&
        runs_evenly(values)) {  // no motion does
      if (counts_samples(values))
        counted_ = counted_.value_or(index);
      else
        unnamed_ = index;
      return true;
    }
    switch (found->kind) {
      case RecognisedColumn::Kind::count:
        if (!rises(values) && !is_dead(values))
          swinging_ = index;
        else if (!counted_)
          counted_ = index;
        break;
      case RecognisedColumn::Kind::frequency:
        if (index == 0 && rises(values) && !stamped_)
          throw InputError(
              {table.file, table.header_line, 0},
              fmt::format("column 1 '{}' is a frequency: a spectrum; expected a record, samples in time",
                          name));
        [[fallthrough]];
      case RecognisedColumn::Kind::other:
        add(other_);
        break;
      case RecognisedColumn::Kind::time:
        if (columns.time || table.time || (rising_ && index != rising_)) {
          clocks_.emplace_back(index, *found);
          add(other_);
        } else if (!found->states_unit && counts_samples(table.columns[index])) {
          counted_ = index;
        } else {
          const bool certain = found->states_unit && mean_step(table.columns[index]) >= found->least_step;
          take_stamps(table, index, certain ? std::optional(found->factor) : std::nullopt, columns);
          unit_is_sure_ = certain;
        }
        break;
      case RecognisedColumn::Kind::signal: {
        if (states_motion_ && !found->states_quantity && !found->states_unit && found->reading.empty() &&
            !is_direction_or_place(name) && std::isfinite(values.front())) {
          add(other_);
          break;
        }
        if (const auto& unit = table.stated_unit;
            unit && !found->states_unit && (!found->states_quantity || found->quantity == unit->first))
          std::tie(found->quantity, found->factor) = certain_unit(table), found->states_unit = true;
        columns.channels.push_back(
            {index, found->factor, {found->quantity, name}, !found->states_quantity && !found->states_unit});
        columns.recognised = true;
        const std::string unit = std::string(si_unit(found->quantity));
        std::string as_it_is;
        if (!found->states_unit && found->reading.empty()) as_it_is = ", its unit taken for " + unit;
        if (!found->states_unit && !found->reading.empty()) {
          if (reading_.empty()) reading_ = found->reading;
          columns.channels.back().factor = size_of_reading(found->reading) / size_of_reading(reading_);
          as_it_is = fmt::format(", 1 {} taken for 1 {}", reading_, unit);
        }
        read_ += fmt::format("{}'{}' as {}{}", read_.empty() ? "" : ", ", name, to_string(found->quantity),
                             as_it_is);
      }
    }
    return true;
  }

  // Stamps alone, where channels are stated.
  void take_time(RecordTable& table, RecordColumns& columns) {
    for (std::size_t index = 0; index < std::min(table.names.size(), table.width()); ++index) {
      const auto found = recognised(table, index);
      if (found && (found->kind == RecognisedColumn::Kind::time ||
                    found->kind == RecognisedColumn::Kind::count || (index == 0 && table.names[0].empty())))
        take(table, index, columns);
    }
    other_.clear(), words_.clear();
    report(table, columns);
  }

  // Says it in one line, and asks the one question that is left.
  void report(RecordTable& table, RecordColumns& columns) {
    if (columns.channels.empty() && first_words_) {
      std::size_t row = 0;
      while (std::isfinite(table.columns[*first_words_][row])) ++row;
      throw table.fault(row, *first_words_);
    }
    if (columns.channels.empty() && swinging_) {  // "Sample", of GeoCSV: the reading, not its number
      const auto [quantity, factor] =
          table.stated_unit ? certain_unit(table) : std::pair{Quantity::acceleration, 1.0};
      columns.channels.push_back({*swinging_, factor, {quantity, table.names[*swinging_]}});
      columns.recognised = true;
      read_ = fmt::format("'{}' as {}{}", table.names[*swinging_], to_string(quantity),
                          table.stated_unit ? "" : ", its unit taken for m/s2");
    }
    if (unnamed_ && !columns.time && !table.time && !stamped_) take_stamps(table, *unnamed_, {}, columns);
    for (const auto& [index, found] : clocks_)
      if (columns.time && !stamped_) require_one_clock(table, *columns.time, unit_is_sure_, index, found);
    const std::string stamps =
        table.time && table.by_people && !column_name_of(table, *table.time).empty()
            ? "'" + column_name_of(table, *table.time) +
                  (holds_stamps(table, *table.time) ? "' as dates or times of day, " : "' as time in s, ")
            : "";
    if (!read_.empty()) table.remarks.push_back("Read: " + stamps + read_ + ".");
    if (!words_.empty()) table.remarks.push_back("Text in place of numbers, omitted: " + words_ + ".");
    if (!other_.empty()) table.remarks.push_back("No channels of motion, omitted: " + other_ + ".");
    if (!columns.time && !table.time) columns.counted = counted_;
    drop_first_zeros(table, columns);
  }

 private:
  std::string read_, other_, words_, reading_;  // reading_: unit of the first sensor's output
  std::optional<std::size_t> rising_, counted_, unnamed_, first_words_, swinging_;
  std::vector<std::pair<std::size_t, RecognisedColumn>> clocks_;  // beside the one that is taken
  bool stamped_, states_motion_, unit_is_sure_ = false;

  // @param factor to seconds, where the file states it
  void take_stamps(const RecordTable& table, std::size_t index, std::optional<double> factor,
                   RecordColumns& columns) {
    if (factor && !(*factor > 0.0) && !stamped_)
      throw InputError(
          {table.file, table.header_line, 0},
          fmt::format("column {} '{}' is in a unit that was not understood; expected the unit of its times: "
                      "--time {}:s, --time {}:ms, --rate HZ, or record.time in the configuration",
                      index + 1, column_name_of(table, index), index + 1, index + 1));
    if (!factor) {
      factor = seconds_of_epoch(table.columns[index]);
      if ((stamped_ || table.stated_rate) && !is_plausible(mean_step(table.columns[index]), *factor)) {
        counted_ = index;  // what is known of the rate is elsewhere
        return;
      }
      require_plausible_step(table, index, *factor);
    }
    columns.time = RecordColumn{index, *factor, {}};
    const std::string name = column_name_of(table, index);
    read_ += fmt::format("{}{} as time in {}", read_.empty() ? "" : ", ",
                         name.empty() ? fmt::format("column {}", index + 1) : "'" + name + "'",
                         symbol_of_time(*factor));
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
    require_plausible_step(table, first, unit);
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
  std::string rising;  // a second clock, a count: no motion does
  const auto only_rises = [](const std::vector<double>& values) {
    constexpr std::size_t enough = 100;  // a slow motion may rise over fewer
    return values.size() > enough && std::ranges::is_sorted(values) && values.front() < values.back();
  };
  const auto [quantity, factor] =
      table.stated_unit ? certain_unit(table) : std::pair{Quantity::acceleration, 1.0};
  for (std::size_t index = first; index < table.width(); ++index)
    if (table.time != index && table.width() > first + 1 && only_rises(table.columns[index]))
      rising += fmt::format("{}{}", rising.empty() ? "" : ", ", index + 1);
    else if (table.time != index && !never_moves(table.columns[index]) && !holds_words(table, index) &&
             !(table.width() > first + 1 && counts_rows(table.columns[index])))
      columns.channels.push_back(
          {index, factor, {quantity, fmt::format("column_{}", index + 1)}, !table.stated_unit});
  if (columns.channels.empty())
    throw InputError({table.file, 0, 0},
                     "no column of numbers moves beside time; expected a measured motion");
  table.remarks.push_back(fmt::format(
      "No header: {}{} {}.",
      columns.time ? fmt::format("column {} is taken for time in {}, ", columns.time->index + 1,
                                 symbol_of_time(columns.time->factor))
                   : "",
      numbers_of(columns.channels),
      table.stated_unit ? "in the unit that the lines above state"
                        : "taken for acceleration in m/s2. Frequency and damping ratio do not depend on it"));
  if (!rising.empty()) table.remarks.push_back("Columns of numbers that only rise, omitted: " + rising + ".");
  leave_out_magnitudes(table, columns);
  return columns;
}

}  // namespace

void find_times(RecordTable& table, RecordColumns& columns) {
  if (table.names.empty())
    take_first_rising(table, false, columns);
  else
    Recognition(table, false).take_time(table, columns);
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
  Recognition recognition(table, stamped);
  for (std::size_t index = 0; index < table.width(); ++index) {
    if (table.time == index) continue;
    auto meaning = stated_meaning(table, index);
    if (table.by_people && meaning && meaning->quantity && !parse_column_name(table.names[index]))
      if (const auto named = recognise_column(table.names[index], "");
          named && named->kind == RecognisedColumn::Kind::other)
        meaning.reset();  // the speed of a car, in m/s
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
      throw InputError(header,
                       fmt::format("columns {0} and {1} are times; expected one of them, and what it is "
                                   "of: --time {0}:s --column N, or --time {1}:s --column N",
                                   columns.time->index + 1, index + 1));
    else
      columns.time = RecordColumn{index, meaning->factor, {}};
  }
  recognition.report(table, columns);
  if (columns.recognised) leave_out_magnitudes(table, columns);
  if (columns.channels.empty() && !unknown.empty())
    throw InputError(
        header, fmt::format("no unit states what is measured: {}; expected {}", unknown, in_configuration));
  if (columns.channels.empty()) throw InputError(header, "no column but time; expected a measured quantity");
  if (!unknown.empty())
    table.remarks.push_back(
        fmt::format("Omitted, as the unit does not determine the quantity: {}.", unknown));
  return columns;
}

}  // namespace beamid::experiments
