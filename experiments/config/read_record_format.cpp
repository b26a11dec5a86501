#include "experiments/config/read_record_format.hpp"

#include <algorithm>
#include <map>

#include "experiments/config/read_beam.hpp"
#include "experiments/config/read_gauge.hpp"
#include "experiments/config/read_preparation.hpp"
#include "experiments/config/vocabulary.hpp"
#include "experiments/record/record_reader.hpp"
#include "experiments/record/units.hpp"
#include "experiments/text/method_choice.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

constexpr int most_columns = 100000, most_header_lines = 1000000;

/// @param what measured: "acceleration", for messages.
double read_factor(const TomlTable& table, const std::string& what, const std::vector<Unit>& known) {
  const std::string expected = "a unit of " + what + ": " + joined(symbols(known));
  if (!table.contains("unit")) table.miss("unit", expected);
  const std::optional<std::string> symbol = table.find_text("unit");
  const auto unit =
      std::find_if(known.begin(), known.end(), [&](const Unit& u) { return u.symbol == *symbol; });
  if (unit == known.end()) table.refuse("unit", expected);
  return unit->factor;
}

ColumnDescription read_column(const TomlTable& table) {
  constexpr const char* expected = "a column's number, from 1, or its name in the header";
  ColumnDescription column;
  const auto value = table.find_value("column");
  if (!value) table.miss("column", expected);
  if (std::holds_alternative<double>(*value))
    column.number = *table.find_whole_number("column", 1, most_columns);
  else if (std::holds_alternative<std::string>(*value))
    column.name = std::get<std::string>(*value);
  if (column.number == 0 && column.name.empty()) table.refuse("column", expected);
  return column;
}

/// @param beam that the sensors sit on; null where none is described: positions are then taken as they are.
ColumnDescription read_channel(const TomlTable& table, const fem::Beam* beam) {
  std::vector<std::string> names;
  for (const Quantity quantity : all_quantities) names.emplace_back(to_string(quantity));
  const std::optional<std::string> name = table.find_text("quantity", names);
  if (!name) table.miss("quantity", "one of " + joined(names));
  ColumnDescription channel = read_column(table);
  channel.quantity = *find_quantity(*name);
  channel.factor = read_factor(table, *name, units(channel.quantity));
  if (beam != nullptr) {
    channel.position = read_position(table, *beam, channel.quantity);
    channel.distance = read_distance(table, *beam, channel.quantity, channel.position);
  } else {
    channel.position = table.find_number("position_m", Sign::not_negative);
    channel.distance = table.find_number("distance_m").value_or(0.0);
  }
  return channel;
}

RecordFormat read_format(const TomlTable& table, const fem::Beam* beam) {
  static const std::map<std::string, char> separators{
      {"auto", '\0'}, {"tab", '\t'}, {"comma", ','}, {"semicolon", ';'}, {"space", ' '}};
  RecordFormat format;
  const std::vector<std::string> names{"auto", "tab", "comma", "semicolon", "space"};
  format.reader = table.find_text("reader").value_or("");
  if (!format.reader.empty())
    at_place(table.value_place("reader"), [&] { record_reader_registry().find(format.reader); });
  format.separator = separators.at(table.find_text("separator", names).value_or("auto"));
  format.header_lines = table.find_whole_number("header_lines", 0, most_header_lines).value_or(0);
  const std::string decimal = table.find_text("decimal", {"auto", "point", "comma"}).value_or("auto");
  format.decimal = decimal == "auto" ? '\0' : decimal == "comma" ? ',' : '.';
  format.skip_malformed = table.find_text("malformed", {"refuse", "skip"}).value_or("refuse") == "skip";
  format.irregular =
      table.find_text("stamps", {"even", "as_they_are"}).value_or("as_they_are") == "as_they_are";
  if (const auto input = table.find_text("input", {"band_limited", "linear", "held"}))
    format.input = *input == "held"     ? InputPath::held
                   : *input == "linear" ? InputPath::linear
                                        : InputPath::band_limited;
  format.sampling_rate = table.find_number("sampling_rate_hz", Sign::positive);
  format.window = table.find_interval("window_s");
  if (format.window) format.window_place = table.value_place("window_s");
  if (const auto time = table.find_table("time")) {
    format.time = read_column(*time);
    format.time->factor = read_factor(*time, "time", time_units());
  }
  for (const TomlTable& channel : table.find_tables("channels"))
    format.channels.push_back(read_channel(channel, beam));
  format.preparation = read_preparation(table);
  return format;
}

}  // namespace

RecordFormat read_record_format(const TomlTable& table, const fem::Beam& beam) {
  return read_format(table, &beam);
}

RecordSection read_record_section(const std::filesystem::path& file) {
  const TomlTable root = TomlTable::read(file);
  refuse_unknown_keys(root);
  const TomlTable record = root.table("record");
  RecordSection section;
  if (root.contains("beam")) {
    const fem::Beam beam = read_beam(root.table("beam"));
    section.format = read_format(record, &beam);
  } else {
    section.format = read_format(record, nullptr);
  }
  section.file = record.find_text("file");
  if (section.file && section.file->empty()) record.refuse("file", "the name of a file");
  return section;
}

}  // namespace beamid::experiments
