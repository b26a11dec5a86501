#include "experiments/record/record.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "experiments/record/units.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/spelling.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

const char* si_unit(Quantity quantity) {
  switch (quantity) {
    case Quantity::displacement:
      return "m";
    case Quantity::velocity:
      return "m/s";
    case Quantity::acceleration:
    case Quantity::base_acceleration:
    case Quantity::support_acceleration:
      return "m/s2";
    case Quantity::force:
      return "N";
    case Quantity::strain:
      return "m/m";
    case Quantity::angular_acceleration:
    case Quantity::support_angular_acceleration:
      return "rad/s2";
  }
  return "";
}

const char* to_string(Quantity quantity) {
  switch (quantity) {
    case Quantity::displacement:
      return "displacement";
    case Quantity::velocity:
      return "velocity";
    case Quantity::acceleration:
      return "acceleration";
    case Quantity::force:
      return "force";
    case Quantity::strain:
      return "strain";
    case Quantity::base_acceleration:
      return "base_acceleration";
    case Quantity::support_acceleration:
      return "support_acceleration";
    case Quantity::angular_acceleration:
      return "angular_acceleration";
    case Quantity::support_angular_acceleration:
      return "support_angular_acceleration";
  }
  return "";
}

Eigen::VectorXd Record::channel(Quantity quantity) const {
  for (Eigen::Index i = 0; i < samples.rows(); ++i)
    if (channels[i].quantity == quantity) return samples.row(i).transpose();
  throw std::invalid_argument(std::string("the record has no channel of ") + to_string(quantity));
}

std::vector<std::string> Record::channel_names() const {
  std::vector<std::string> names;
  for (const Channel& channel : channels) {
    const bool alone = std::count_if(channels.begin(), channels.end(),
                                     [&](const Channel& other) { return other.name == channel.name; }) == 1;
    names.push_back(alone ? channel.name : channel.name + " " + to_string(channel.quantity));
  }
  return names;
}

Record Record::window(double from, double to) const {
  constexpr Eigen::Index fewest = 16;
  const double slack = 0.5 * interval();
  const double* const first = std::lower_bound(time.data(), time.data() + size(), from - slack);
  const double* const last = std::upper_bound(time.data(), time.data() + size(), to + slack);
  const Eigen::Index begin = first - time.data(), count = last - first;
  if (!(from >= time[0] - slack && to <= time[size() - 1] + slack) || count < fewest) {
    std::ostringstream message;
    message << "window " << from << " to " << to << " s; expected at least " << fewest
            << " samples inside the record, which runs from " << time[0] << " to " << time[size() - 1]
            << " s";
    throw std::invalid_argument(message.str());
  }
  Record part = *this;
  part.time = time.segment(begin, count);
  part.samples = samples.middleCols(begin, count);
  return part;
}

std::optional<double> seconds_per(const std::string& unit, const std::string& what, const std::string& file,
                                  const RecordFormat& format) {
  if (unit.empty()) return 1.0;
  std::string small = unit;  // old programs write "SEC"
  for (char& letter : small)
    letter = letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter + 32) : letter;
  for (const std::string& spelling : {unit, small})
    if (const auto stated = stated_unit(spelling); stated && !stated->quantity) return stated->factor;
  if (const auto seconds = unit_of_times(unit)) return seconds;
  if (format.time || format.sampling_rate) return std::nullopt;
  throw InputError({file}, fmt::format("{} is in '{}'; expected times in {}, or record.time or "
                                       "record.sampling_rate_hz in the configuration",
                                       what, unit, joined(symbols(time_units()))));
}

namespace {

void append(std::string& text, double value, int digits) {
  char buffer[40];
  char* const end = buffer + sizeof(buffer);
  const auto result = digits > 0 ? std::to_chars(buffer, end, value, std::chars_format::general, digits)
                                 : std::to_chars(buffer, end, value);
  text.append(buffer, result.ptr);
}

}  // namespace

std::string to_csv(const Record& record, int digits) {
  constexpr int most = 17;  // more say nothing about a double
  if (digits < 0 || digits > most)
    throw std::invalid_argument(fmt::format("digits is {}; expected 0 to {}", digits, most));
  const auto channels = static_cast<Eigen::Index>(record.channels.size());
  if (record.samples.rows() != channels || record.samples.cols() != record.size())
    throw std::invalid_argument(fmt::format("samples are {} x {}; expected {} channels x {} instants",
                                            record.samples.rows(), record.samples.cols(), channels,
                                            record.size()));
  if (!record.samples.allFinite() || !record.time.allFinite())
    throw std::invalid_argument("a record with NaN or infinity; expected finite numbers");
  std::string text;
  for (const std::string& name : column_names(record)) text += (text.empty() ? "" : ",") + csv_field(name);
  text += '\n';
  for (Eigen::Index instant = 0; instant < record.size(); ++instant) {
    append(text, record.time[instant], digits);
    for (Eigen::Index channel = 0; channel < channels; ++channel) {
      text += ',';
      append(text, record.samples(channel, instant), digits);
    }
    text += '\n';
  }
  return text;
}

void write_record(const Record& record, const std::filesystem::path& file, int digits) {
  const std::string text = to_csv(record, digits);
  std::filesystem::path part = file;
  part += ".part";
  std::ofstream stream(part, std::ios::binary);
  stream << text;
  stream.close();
  std::error_code failure;
  if (stream) std::filesystem::rename(part, file, failure);
  if (stream && !failure) return;
  std::error_code ignored;
  std::filesystem::remove(part, ignored);
  throw std::runtime_error(file.string() + ": cannot be written" + (failure ? ": " + failure.message() : ""));
}

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
      if (columns[i] != *name) continue;
      if (!channel.position && channel.place.empty()) {
        channel.position = one.find_number("position_m", Sign::not_negative);
        channel.place = one.find_text("at").value_or("");
      }
      if (channel.distance == Channel{}.distance)
        channel.distance = one.find_number("distance_m").value_or(channel.distance);
      if (!(channel.noise > 0.0))
        if (const auto noise = one.find_number("noise", Sign::not_negative))
          channel.noise =
              *noise * unit_factor(one.find_text("unit").value_or(""), channel.quantity).value_or(1.0);
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
      "# What the header of the record does not state: where its channels were measured. Commands that read "
      "the\n"
      "# record read this file with it; it may also stand in an experiment file.\n\n[record]\nfile = " +
      toml_string(file_name) + "\n";
  if (record.input_path)
    text += fmt::format("input = \"{}\"\n", path_names[static_cast<int>(*record.input_path)]);
  const std::vector<std::string> columns = column_names(record);
  for (std::size_t i = 0; i < record.channels.size(); ++i) {
    const Channel& channel = record.channels[i];
    text += fmt::format("\n[[record.channels]]\ncolumn = {}\nquantity = \"{}\"\nunit = \"{}\"\n",
                        toml_string(columns[i + 1]), to_string(channel.quantity),
                        units(channel.quantity).front().symbol);
    if (channel.position) text += fmt::format("position_m = {}\n", *channel.position);
    if (!channel.place.empty()) text += fmt::format("at = {}\n", toml_string(channel.place));
    if (channel.noise > 0.0) text += fmt::format("noise = {}\n", channel.noise);
    if (channel.quantity == Quantity::strain) text += fmt::format("distance_m = {}\n", channel.distance);
  }
  return text;
}

}  // namespace beamid::experiments
