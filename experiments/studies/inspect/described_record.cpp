#include "experiments/studies/inspect/inspection_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "experiments/config/readers.hpp"
#include "experiments/record/read_record.hpp"
#include "experiments/record/record_columns.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/record/units.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

std::optional<std::string> symbol_of(double factor, const std::vector<Unit>& known) {
  for (const Unit& unit : known)
    if (std::abs(unit.factor - factor) <= 1e-12 * factor) return unit.symbol;
  return {};
}

/// One line of [record] for each way in which the file is to be read that is not the usual one.
std::string reading_keys(const RecordFormat& format) {
  const RecordFormat usual;
  std::string text;
  const auto key = [&](const char* name, const std::string& value) {
    text += fmt::format("{} = {}\n", name, value);
  };
  if (!format.reader.empty()) key("reader", toml_string(format.reader));
  for (const auto& [sign, name] :
       {std::pair{'\t', "tab"}, {',', "comma"}, {';', "semicolon"}, {'|', "bar"}, {' ', "space"}})
    if (format.separator == sign) key("separator", toml_string(name));
  if (format.decimal != usual.decimal) key("decimal", format.decimal == ',' ? "\"comma\"" : "\"point\"");
  if (format.header_lines > 0) key("header_lines", std::to_string(format.header_lines));
  if (format.malformed == MalformedRows::skip) key("malformed", "\"skip\"");
  if (!format.irregular) key("stamps", "\"even\"");
  if (format.sampling_rate) key("sampling_rate_hz", fmt::format("{:.15g}", *format.sampling_rate));
  if (format.window)
    key("window_s", fmt::format("[{:.12g}, {:.12g}]", format.window->first, format.window->second));
  return text;
}

/// The channels with quantity and unit; empty where a unit has no symbol in an experiment file: the record's
/// file states it then.
std::string channel_key(const RecordColumns& columns) {
  std::string text;
  for (const RecordColumn& column : columns.channels) {
    const Channel& channel = column.channel;
    const auto symbol = symbol_of(column.factor, units(channel.quantity));
    if (!symbol) return "";
    text += fmt::format("  {{ column = {}, quantity = \"{}\", unit = \"{}\"", column.index + 1,
                        to_string(channel.quantity), *symbol);
    if (channel.position) text += fmt::format(", position_m = {:.12g}", *channel.position);
    if (!channel.place.empty()) text += ", place = " + toml_string(channel.place);
    text += " },  # " + channel.name + "\n";
  }
  return "channels = [\n" + text + "]\n";
}

}  // namespace

std::string described_record(const std::filesystem::path& file, const RecordFormat& format,
                             const std::filesystem::path& folder) {
  const Record record = read_record(file, format);
  RecordTable table = read_table(file, format);
  RecordColumns columns = find_columns(table, format);
  if (columns.recognised) leave_out_still(table, columns);
  const std::filesystem::path place = std::filesystem::absolute(file).lexically_relative(
      std::filesystem::absolute(folder).lexically_normal());
  std::string text = "[record]\nfile = " +
                     toml_string(place.empty() ? std::filesystem::absolute(file).string() : place.string()) +
                     "\n";
  text += reading_keys(format);
  if (columns.recognised && format.malformed == MalformedRows::refuse && record.samples.array().isNaN().any())
    text += "malformed = \"missing\"\n";
  if (columns.time && columns.time->index != table.time)
    if (const auto symbol = symbol_of(columns.time->factor, time_units()))
      text += fmt::format("time = {{ column = {}, unit = \"{}\" }}\n", columns.time->index + 1, *symbol);
  text += channel_key(columns);
  for (const std::string& remark : table.remarks) text += "# " + remark + "\n";

  const TomlTable read_back = TomlTable::parse(text, "record");
  const Record again = read_record(file, read_record_section(read_back.table("record"), nullptr).format);
  if (again.samples.rows() != record.samples.rows() || again.size() != record.size() ||
      !(again.time - record.time).isZero(1e-9 * record.interval()) ||
      !(again.samples - record.samples)
           .unaryExpr([](double d) { return std::isnan(d) ? 0.0 : d; })
           .isZero(0.0))
    throw InputError(
        {file.string(), 0, 0},
        "a table [record] does not describe it: read by one, its samples differ; expected options "
        "on the command line in place of it");
  return text +
         "\n# What identify, check and update need besides: the structure. Starters to copy from:\n"
         "# beamid new cantilever.toml, or --structure chain, frame and others (beamid new --help).\n";
}

}  // namespace beamid::experiments
