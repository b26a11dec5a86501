#include "experiments/record/record_places.hpp"

#include <fmt/format.h>

#include "experiments/record/column_name.hpp"
#include "experiments/record/units.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

constexpr const char* path_names[] = {"band_limited", "linear", "held"};

}  // namespace

std::filesystem::path places_file(const std::filesystem::path& record) {
  std::filesystem::path file = record;
  return file.replace_extension(".toml");
}

void take_places(const std::filesystem::path& file, const std::vector<std::string>& columns, Record& record) {
  const std::filesystem::path beside = places_file(file);
  std::error_code ignored;
  if (beside == file || !std::filesystem::is_regular_file(beside, ignored)) return;
  const TomlTable root = TomlTable::read(beside);
  const auto section = root.find_table("record");
  if (!section || section->find_text("file") != file.filename().string()) return;
  for (const TomlTable& one : section->find_tables("channels")) {
    const auto value = one.find_value("column");
    const auto* const name = value ? std::get_if<std::string>(&*value) : nullptr;
    for (std::size_t i = 0; name && i < record.channels.size(); ++i) {
      Channel& channel = record.channels[i];
      if (columns[i] != *name || channel.position) continue;
      channel.position = one.find_number("position_m", Sign::not_negative);
      channel.place = one.find_text("at").value_or("");
      channel.distance = one.find_number("distance_m").value_or(channel.distance);
      channel.noise = one.find_number("noise").value_or(channel.noise);
    }
  }
  if (record.input_path) return;
  if (const auto word = section->find_text("input", {path_names[0], path_names[1], path_names[2]}))
    record.input_path = *word == path_names[0]   ? InputPath::band_limited
                        : *word == path_names[1] ? InputPath::linear
                                                 : InputPath::held;
}

std::string places_text(const Record& record, const std::string& file_name) {
  std::string text =
      "# What the header of the record does not say: where its channels were measured. Commands that read "
      "the\n"
      "# record read this file with it; it may also stand in an experiment file.\n\n[record]\nfile = \"" +
      file_name + "\"\n";
  if (record.input_path)
    text += fmt::format("input = \"{}\"\n", path_names[static_cast<int>(*record.input_path)]);
  const std::vector<std::string> columns = column_names(record);
  for (std::size_t i = 0; i < record.channels.size(); ++i) {
    const Channel& channel = record.channels[i];
    text += fmt::format("\n[[record.channels]]\ncolumn = \"{}\"\nquantity = \"{}\"\nunit = \"{}\"\n",
                        columns[i + 1], to_string(channel.quantity), units(channel.quantity).front().symbol);
    if (channel.position) text += fmt::format("position_m = {}\n", *channel.position);
    if (!channel.place.empty()) text += fmt::format("at = \"{}\"\n", channel.place);
    if (channel.noise > 0.0) text += fmt::format("noise = {}\n", channel.noise);
    if (channel.quantity == Quantity::strain) text += fmt::format("distance_m = {}\n", channel.distance);
  }
  return text;
}

}  // namespace beamid::experiments
