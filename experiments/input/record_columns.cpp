#include "experiments/input/record_columns.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/input/column_name.hpp"
#include "experiments/input/spelling.hpp"

namespace beamid::experiments {
namespace {

RecordColumn find_column(const DelimitedText& text, const ColumnDescription& wanted) {
  const std::vector<std::string>& names = text.names();
  RecordColumn column{static_cast<std::size_t>(wanted.number) - 1,
                      wanted.factor,
                      {wanted.quantity, wanted.name, wanted.position, wanted.distance}};
  if (wanted.name.empty()) {
    if (column.index >= text.width())
      throw InputError(text.row_place(), fmt::format("{}; expected at least {}, the column asked for",
                                                     count_of_columns(text.width()), wanted.number));
    if (column.index < names.size()) column.channel.name = names[column.index];
    if (column.channel.name.empty()) column.channel.name = to_string(wanted.quantity);
    return column;
  }
  if (names.empty())
    throw InputError({text.file(), 0, 0},
                     fmt::format("no header; expected one that names the column '{}'", wanted.name));
  const Place header{text.file(), text.header_line(), 1};
  const auto match = std::find(names.begin(), names.end(), wanted.name);
  if (match == names.end()) {
    const auto meant = nearest(wanted.name, names);
    throw InputError(header, fmt::format("no column '{}'{}; the header names: {}", wanted.name,
                                         meant ? "; did you mean '" + *meant + "'?" : "", joined(names)));
  }
  if (std::find(match + 1, names.end(), wanted.name) != names.end())
    throw InputError(header, fmt::format("several columns '{}'; expected one, or its number", wanted.name));
  column.index = static_cast<std::size_t>(match - names.begin());
  if (column.index >= text.width())
    throw InputError(text.row_place(),
                     fmt::format("{}; expected {} for the column '{}'", count_of_columns(text.width()),
                                 column.index + 1, wanted.name));
  return column;
}

RecordColumns columns_of_header(const DelimitedText& text) {
  RecordColumns columns;
  const std::vector<std::string>& names = text.names();
  const Place header{text.file(), text.header_line(), 0};
  if (names.empty())
    throw InputError({text.file()},
                     fmt::format("no header; expected one that names every column with its unit ({}), or "
                                 "record.channels in the configuration",
                                 known_column_names()));
  if (names.size() != text.width())
    throw InputError(header,
                     fmt::format("a header of {} names for {}; expected one each, with its unit ({}), or "
                                 "record.channels in the configuration",
                                 names.size(), count_of_columns(text.width()), known_column_names()));
  for (std::size_t index = 0; index < names.size(); ++index) {
    const auto meaning = parse_column_name(names[index]);
    if (!meaning)
      throw InputError(
          header, fmt::format("unknown column '{}'; expected names with units ({}), or record.channels in "
                              "the configuration",
                              names[index], known_column_names()));
    if (meaning->quantity)
      columns.channels.push_back(
          {index,
           meaning->factor,
           {*meaning->quantity, meaning->label.empty() ? to_string(*meaning->quantity) : meaning->label}});
    else if (columns.time)
      throw InputError(header, "two columns of time; expected one");
    else
      columns.time = RecordColumn{index, meaning->factor, {}};
  }
  if (columns.channels.empty()) throw InputError(header, "no column but time; expected a measured quantity");
  return columns;
}

}  // namespace

RecordColumns find_columns(const DelimitedText& text, const RecordFormat& format) {
  RecordColumns columns;
  if (format.channels.empty()) columns = columns_of_header(text);
  for (const ColumnDescription& wanted : format.channels)
    columns.channels.push_back(find_column(text, wanted));
  if (format.time) columns.time = find_column(text, *format.time);
  for (std::size_t index = 0; !columns.time && index < std::min(text.names().size(), text.width()); ++index)
    if (const auto meaning = parse_column_name(text.names()[index]); meaning && !meaning->quantity)
      columns.time = RecordColumn{index, meaning->factor, {}};
  if (!columns.time && !format.sampling_rate)
    throw InputError({text.file(), 0, 0},
                     "no times; expected a column time_s, or record.time or record.sampling_rate_hz in the "
                     "configuration");
  return columns;
}

}  // namespace beamid::experiments
