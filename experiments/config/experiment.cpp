#include "experiments/config/experiment.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include <fmt/format.h>

#include "experiments/config/readers.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/models/structure_points.hpp"
#include "experiments/record/units.hpp"

namespace beamid::experiments {

const char* to_string(Excitation::Kind kind) {
  switch (kind) {
    case Excitation::Kind::release:
      return "release";
    case Excitation::Kind::step:
      return "static";
    case Excitation::Kind::impulse:
      return "impulse";
    case Excitation::Kind::harmonic:
      return "harmonic";
    case Excitation::Kind::random:
      return "random";
    case Excitation::Kind::base:
      return "base";
    case Excitation::Kind::table:
      return "table";
    case Excitation::Kind::free:
      break;
  }
  return "none";
}

using Response = FrequencyResponseSettings::Kind;

const char* to_string(Response kind) {
  return kind == Response::receptance ? "receptance"
         : kind == Response::mobility ? "mobility"
                                      : "accelerance";
}

const char* unit_of(Response kind) {
  return kind == Response::receptance ? "m/N" : kind == Response::mobility ? "m/(N s)" : "1/kg";
}

const char* suffix_of(Response kind) {
  return kind == Response::receptance ? "m_per_n" : kind == Response::mobility ? "m_per_n_s" : "per_kg";
}

namespace {

// "x0.25m", in a column's name "x0_25m", "tip", "root", also where a second channel of that name has been
// numbered: "tip_2".
std::optional<double> place_in_name(std::string name, double length) {
  if (const std::size_t number = name.rfind('_');
      number != std::string::npos && name.find_first_not_of("0123456789", number + 1) == std::string::npos)
    name.erase(number);
  if (name == "tip") return length;
  if (name == "root") return 0.0;
  std::replace(name.begin(), name.end(), '_', '.');
  if (name.size() < 3 || name.front() != 'x' || name.back() != 'm') return {};
  double position = 0.0;
  const char* const end = name.data() + name.size() - 1;
  const auto [rest, error] = std::from_chars(name.data() + 1, end, position);
  if (error != std::errc() || rest != end || !(position >= 0.0 && position <= length)) return {};
  return position;
}

// Whether columns of these channels have one name: as close as a file keeps it.
bool same_column(const Channel& one, const Channel& other) {
  Record first, second;
  first.channels = {one};
  second.channels = {other};
  return column_names(first)[1] == column_names(second)[1];
}

double place_of(const Sensor& sensor, const fem::Structure& structure) {
  return sensor.position.value_or(fem::natural_point(structure).position);
}

std::string name_of(const Sensor& sensor, const fem::Structure& structure) {
  if (!sensor.name.empty()) return sensor.name;
  if (!structure.has_positions()) return sensor.place;
  return name_of_place(place_of(sensor, structure), structure.extent());
}

// The sensor that a channel comes from; null where none is named like it and several are of its quantity.
const Sensor* sensor_of(const Channel& channel, const Experiment& experiment) {
  const Sensor* only = nullptr;
  int alike = 0;
  for (const Sensor& sensor : experiment.sensors) {
    if (sensor.quantity != channel.quantity) continue;
    if (same_column(channel, {sensor.quantity, name_of(sensor, experiment.structure)})) return &sensor;
    only = &sensor;
    ++alike;
  }
  return alike == 1 ? only : nullptr;
}

[[noreturn]] void refuse_unplaced(const Channel& channel, const Experiment& experiment) {
  std::string named;
  for (const Sensor& sensor : experiment.sensors)
    if (sensor.quantity == channel.quantity && !sensor.name.empty())
      named += (named.empty() ? "" : ", ") + sensor.name;
  throw std::invalid_argument(
      fmt::format("where channel '{}' ({}) sits on the {} is not known; expected {} in "
                  "[[record.channels]]{}, or a "
                  "[[sensors]] of that name{}",
                  channel.name, to_string(channel.quantity), experiment.structure.kind(),
                  experiment.structure.has_positions() ? "position_m" : "at",
                  channel.quantity == Quantity::strain ? " with the gauge's distance_m" : "",
                  named.empty() ? "" : "; the file names " + named));
}

// Channels of a structure whose places have names: no place is the natural one.
Record with_named_places(Record record, const Experiment& experiment) {
  const std::vector<std::string> places = fem::place_names(experiment.structure);
  for (Channel& channel : record.channels) {
    if (channel.quantity == Quantity::base_acceleration) continue;  // of all supports
    if (channel.place.empty())
      if (const Sensor* const sensor = sensor_of(channel, experiment)) channel.place = sensor->place;
    for (const std::string& place : places)
      if (channel.place.empty() && same_column(channel, {channel.quantity, place})) channel.place = place;
    if (channel.place.empty()) refuse_unplaced(channel, experiment);
    if (std::find(places.begin(), places.end(), channel.place) == places.end())
      throw std::invalid_argument(fmt::format("channel '{}' sits at '{}'; expected {}", channel.name,
                                              channel.place, expected_place(experiment.structure)));
  }
  return record;
}

}  // namespace

Record with_places(Record record, const Experiment& experiment) {
  const fem::Structure& structure = experiment.structure;
  if (!structure.has_positions()) return with_named_places(std::move(record), experiment);
  const double length = structure.extent();
  std::vector<Channel*> left;
  for (Channel& channel : record.channels) {
    if (channel.quantity == Quantity::base_acceleration) continue;  // of all supports
    const bool gauge = channel.quantity == Quantity::strain;
    if (channel.position && (!gauge || channel.distance != 0.0)) continue;
    const Sensor* const sensor = sensor_of(channel, experiment);
    if (sensor) {
      channel.position = place_of(*sensor, structure);
      channel.distance = sensor->distance;
    } else if (!channel.position && !gauge) {
      channel.position = place_in_name(channel.name, length);
    }
    if (!channel.position || (gauge && channel.distance == 0.0)) left.push_back(&channel);
  }
  for (Channel* const channel : left) {
    const auto alike = [&](const auto& other) { return other.quantity == channel->quantity; };
    const bool one = std::count_if(left.begin(), left.end(), [&](const Channel* other) {
                       return other->quantity == channel->quantity;
                     }) == 1;
    const bool sensors = std::any_of(experiment.sensors.begin(), experiment.sensors.end(), alike);
    if (!one || sensors || channel->quantity == Quantity::strain) refuse_unplaced(*channel, experiment);
  }
  for (Channel* const channel : left) channel->position = fem::natural_point(structure).position;
  return record;
}

std::string channel_text(const Channel& channel) {
  const std::string where = at_place_text(channel.position, channel.place);
  const std::string quantity = to_string(channel.quantity);
  return (channel.name.empty() || channel.name == quantity ? quantity : channel.name + ": " + quantity) +
         where;
}

std::string channels_text(const Record& record) {
  std::string text;
  for (const Channel& channel : record.channels) text += (text.empty() ? "" : ", ") + channel_text(channel);
  return text;
}

nlohmann::ordered_json channel_values(const Record& record) {
  nlohmann::ordered_json values = nlohmann::ordered_json::array();
  for (const Channel& channel : record.channels) {
    values.push_back({{"name", channel.name},
                      {"quantity", to_string(channel.quantity)},
                      {"unit", si_unit(channel.quantity)}});
    values.back()["position_m"] =
        channel.position ? nlohmann::ordered_json(*channel.position) : nlohmann::ordered_json(nullptr);
    if (!channel.place.empty()) values.back()["at"] = channel.place;
  }
  return values;
}

using filters::OnFailure;

const char* to_string(OnFailure response) {
  switch (response) {
    case OnFailure::inflate:
      return "inflate";
    case OnFailure::report:
      return "report";
    case OnFailure::stop:
      break;
  }
  return "stop";
}

OnFailure failure_response(const std::string& name) {
  for (const OnFailure response : {OnFailure::stop, OnFailure::inflate, OnFailure::report})
    if (name == to_string(response)) return response;
  throw std::invalid_argument("on_failure is '" + name + "'; expected stop, inflate, report");
}

}  // namespace beamid::experiments
