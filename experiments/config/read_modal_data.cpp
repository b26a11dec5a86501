
#include "experiments/config/readers.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <filesystem>
#include <numbers>

#include <fmt/format.h>

#include "experiments/config/experiment.hpp"
#include "experiments/config/schema.hpp"
#include "experiments/modal/modal_data.hpp"
#include "experiments/modal/poles.hpp"
#include "experiments/modal/universal_modes.hpp"
#include "experiments/results/results.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

// The results.json of `beamid modal`, read as measured modes.

using Json = nlohmann::ordered_json;
using Complex = std::complex<double>;

double json_number(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<double>() : 0.0;
}

/// Powers of i omega between a channel's quantity and a displacement; nothing for others, as strains.
std::optional<int> omega_power(const std::string& unit) {
  if (unit == "m") return 0;
  if (unit == "m/s") return 1;
  if (unit == "m/s2") return 2;
  return std::nullopt;
}

/// The sensor of each channel; empty when they are not the experiment's.
std::vector<std::size_t> sensors_of_channels(const Json& shape, const std::vector<Sensor>& sensors,
                                             bool& by_name) {
  std::vector<std::size_t> places;
  for (const Json& entry : shape) {
    const std::string name = entry.value("channel", "");
    const auto found = std::find_if(sensors.begin(), sensors.end(),
                                    [&](const Sensor& sensor) { return sensor.name == name; });
    if (found != sensors.end() && !name.empty()) places.push_back(found - sensors.begin());
  }
  by_name = places.size() == shape.size();
  if (by_name) return places;
  places.clear();
  if (shape.size() != sensors.size()) return places;
  for (std::size_t i = 0; i < sensors.size(); ++i) places.push_back(i);
  return places;
}

MeasuredMode measured_mode_of(const Json& json, const std::filesystem::path& file,
                              const Experiment& experiment, ModalData& data) {
  MeasuredMode mode{json_number(json, "frequency_hz"), json_number(json, "frequency_standard_deviation_hz")};
  if (!(mode.frequency_hz > 0.0))
    throw InputError({file.string()},
                     "a mode has no positive frequency_hz; expected results of beamid modal");
  const Json shape = json.value("shape", Json::array());
  if (shape.size() < 2) return mode;
  bool by_name = false;
  const std::vector<std::size_t> places = sensors_of_channels(shape, experiment.sensors, by_name);
  if (places.empty())
    throw InputError({file.string()},
                     fmt::format("shapes at {} channels, and {} [[sensors]] in the experiment file; expected "
                                 "sensors of the channels' names, or as many in their order",
                                 shape.size(), experiment.sensors.size()));
  if (!by_name && data.remarks.empty())
    data.remarks.emplace_back(
        "No sensor has a channel's name: channels are taken for the sensors in their order.");
  Eigen::VectorXcd complex = Eigen::VectorXcd::Zero(static_cast<Eigen::Index>(experiment.sensors.size()));
  if (places.size() < experiment.sensors.size())
    throw InputError({file.string()}, fmt::format("shapes at {} channels for {} [[sensors]]; expected one "
                                                  "for each",
                                                  shape.size(), experiment.sensors.size()));
  double relative = 0.0;
  for (std::size_t c = 0; c < shape.size(); ++c) {
    const std::string unit = shape[c].value("unit", "");
    const auto power = omega_power(unit);
    if (!power)
      throw InputError({file.string()},
                       fmt::format("channel '{}' has the unit '{}'; expected displacements, velocities or "
                                   "accelerations",
                                   shape[c].value("channel", ""), unit));
    const Complex factor = std::pow(Complex(0.0, 2.0 * std::numbers::pi * mode.frequency_hz), *power);
    complex[static_cast<Eigen::Index>(places[c])] =
        std::polar(json_number(shape[c], "amplitude"), json_number(shape[c], "phase_rad")) / factor;
    relative = std::max(relative, json_number(shape[c], "relative_standard_deviation"));
  }
  mode.shape = nearest_real(complex);
  mode.shape_deviation = relative * mode.shape.cwiseAbs().maxCoeff();
  return mode;
}

ModalData modes_in(const Json& json, const std::filesystem::path& file, const Experiment& experiment) {
  ModalData data{file.string(), {}};
  if (json.value("command", "") != "modal" || !json.contains("records") || !json["records"].is_array() ||
      json["records"].empty())
    throw InputError({file.string()}, fmt::format("results of the command '{}'; expected those of modal",
                                                  json.value("command", "")));
  for (const Json& message : json.value("messages", Json::array()))
    if (message.value("severity", "") != to_string(Severity::note))
      data.objections.push_back(message.value("text", ""));
  if (json.contains("modes")) {  // of hits, by --method frf_lscf or frf_half_power
    for (const Json& mode : json["modes"])
      data.modes.push_back(
          {json_number(mode, "frequency_hz"), json_number(mode, "frequency_standard_deviation_hz")});
    data.remarks.emplace_back("Of frequency responses to hits the frequencies are used, and no shapes.");
  } else if (json["records"].size() == 1) {
    for (const Json& mode : json["records"][0].value("modes", Json::array()))
      data.modes.push_back(measured_mode_of(mode, file, experiment, data));
  } else {
    for (const Json& merged : json.value("merged_modes", Json::array())) {
      const Json& value = merged["frequency_hz"];
      data.modes.push_back(
          {json_number(value, "mean"), std::max(json_number(value, "standard_deviation"),
                                                json_number(value, "standard_deviation_between_records"))});
    }
    data.remarks.emplace_back("Of several records the merged frequencies are used, and no shapes.");
  }
  if (data.modes.empty())
    throw InputError({file.string()}, "beamid modal found no modes there; expected one at least");
  return data;
}

/// As read_modal_data() says. @throws InputError when the file is none that `beamid modal` wrote, or its
/// channels are not the experiment's sensors.
ModalData read_modal_json(const std::filesystem::path& file, const Experiment& experiment) {
  const Json json = read_json(file, "the results of beamid modal");
  try {
    return modes_in(json, file, experiment);
  } catch (const Json::exception& error) {
    throw InputError({file.string()}, std::string("not as beamid modal writes it: ") + error.what() +
                                          "; expected its results.json as it is");
  }
}

/// A mode as a file describes it.
struct DescribedMode {
  double frequency = 0.0;
  std::optional<double> deviation, relative_deviation;
  std::optional<std::vector<double>> shape;
  std::optional<double> shape_deviation;
  std::optional<int> number;
};

constexpr int most_measured_modes = 1000;

const Schema<DescribedMode>& measured_mode_keys() {
  using M = DescribedMode;
  static const Schema<M> keys =
      Schema<M>("modes")
          .key("frequency_hz", &M::frequency, positive, "natural frequency", "2.7477")
          .required("a positive number of Hz")
          .key("frequency_standard_deviation_hz", &M::deviation, positive, "its standard deviation", "0.005")
          .excludes({"frequency_relative_deviation"}, "one of them")
          .key("frequency_relative_deviation", &M::relative_deviation, positive,
               "the same as a part of the frequency", "0.002")
          .key("shape", &M::shape, "displacements at the sensors, in their order, of any scale",
               "[0.35, 0.65, 0.87, 1.0]")
          .key("shape_standard_deviation", &M::shape_deviation, positive, "of each component, in that scale",
               "0.03")
          .key("mode", &M::number, {1, most_measured_modes}, "its number, where it is known", "3");
  return keys;
}

MeasuredMode measured_mode(const TomlTable& table, std::size_t sensors) {
  for (const std::string& key : table.keys())
    if (!measured_mode_keys().find(key))
      throw InputError(table.key_place(key), fmt::format("unknown key modes.{}; expected one of: {}", key,
                                                         fmt::join(measured_mode_keys().names(), ", ")));
  const DescribedMode described = measured_mode_keys().read(table);
  MeasuredMode mode{
      described.frequency,
      described.deviation.value_or(described.relative_deviation.value_or(0.0) * described.frequency)};
  mode.number = described.number;
  if (!described.shape) {
    if (described.shape_deviation)
      throw InputError(table.key_place("shape_standard_deviation"),
                       "modes.shape_standard_deviation without a shape; expected shape beside it");
    return mode;
  }
  if (described.shape->size() != sensors)
    throw InputError(
        table.value_place("shape"),
        fmt::format("modes.shape has {} numbers; expected {}, one for each of the [[sensors]] of "
                    "the experiment file, in their order",
                    described.shape->size(), sensors));
  mode.shape = Eigen::Map<const Eigen::VectorXd>(described.shape->data(),
                                                 static_cast<Eigen::Index>(described.shape->size()));
  if (mode.shape.isZero(0.0)) table.refuse("shape", "a number other than zero among them");
  mode.shape_deviation = described.shape_deviation.value_or(0.0);
  return mode;
}

ModalData read_modes_toml(const std::filesystem::path& file, const Experiment& experiment) {
  const TomlTable root = TomlTable::read(file);
  for (const std::string& key : root.keys())
    if (key != "modes")
      throw InputError(root.key_place(key), fmt::format("unknown key {}; expected [[modes]] alone", key));
  ModalData data;
  data.source = file.string();
  for (const TomlTable& table : root.find_tables("modes"))
    data.modes.push_back(measured_mode(table, experiment.sensors.size()));
  if (data.modes.empty()) throw InputError({file.string()}, "no modes; expected tables [[modes]]");
  return data;
}

// Universal Files of this and other programs.

/// A node of a file and the axis along which it moves.
struct NodeAxis {
  Eigen::Index node = 0, axis = 0;
};

/// Those that move in any mode, more than a millionth of the mode's largest displacement: nodes in the file's
/// order.
std::vector<NodeAxis> moving_axes(const NodalModes& modes) {
  std::vector<NodeAxis> moving;
  for (Eigen::Index node = 0; node < modes.places.cols(); ++node)
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      if (std::ranges::any_of(modes.modes, [&](const NodalModes::Mode& mode) {
            return std::abs(mode.shape(axis, node)) > 1e-6 * mode.shape.cwiseAbs().maxCoeff();
          }))
        moving.push_back({node, axis});
  return moving;
}

/// The node and axis of each sensor by its position along x; empty where sensors have none, where nodes move
/// along several axes, or where a sensor has no node of its own there.
std::vector<NodeAxis> nodes_at_sensors(const NodalModes& modes, const std::vector<NodeAxis>& moving,
                                       const std::vector<Sensor>& sensors) {
  std::vector<NodeAxis> places;
  const double extent = modes.places.row(0).maxCoeff() - modes.places.row(0).minCoeff();
  constexpr double six_digits = 1e-5;
  for (const NodeAxis& one : moving)
    if (one.axis != moving.front().axis) return {};
  for (const Sensor& sensor : sensors) {
    if (!sensor.position || !(extent > 0.0)) return {};
    std::vector<NodeAxis> there;
    for (Eigen::Index node = 0; node < modes.places.cols(); ++node)
      if (std::abs(modes.places(0, node) - *sensor.position) <= six_digits * extent)
        there.push_back({node, moving.front().axis});
    if (there.size() != 1) return {};
    places.push_back(there.front());
  }
  return places;
}

ModalData read_modes_uff(const std::filesystem::path& file, const Experiment& experiment) {
  const NodalModes found = read_universal_modes(file);
  const std::vector<Sensor>& sensors = experiment.sensors;
  ModalData data{file.string(), {}};
  const std::vector<NodeAxis> moving = moving_axes(found);
  std::vector<NodeAxis> places = nodes_at_sensors(found, moving, sensors);
  if (sensors.size() < 2) {
    places.clear();
    data.remarks.emplace_back(
        "Without two [[sensors]] in the experiment file the frequencies are used, and no shapes.");
  } else if (places.empty()) {
    if (moving.size() != sensors.size())
      throw InputError(
          {file.string()},
          fmt::format(
              "shapes of {} degrees of freedom at {} nodes, and {} [[sensors]] in the experiment file; "
              "expected a node at the position_m of each sensor, or as many degrees of freedom in their "
              "order",
              moving.size(), found.places.cols(), sensors.size()));
    places = moving;
    data.remarks.emplace_back(
        "No sensor's position_m is a node's: degrees of freedom are taken for the sensors in their order.");
  }
  for (const NodalModes::Mode& mode : found.modes) {
    MeasuredMode measured{mode.frequency_hz, mode.frequency_deviation_hz.value_or(0.0)};
    Eigen::VectorXcd shape(static_cast<Eigen::Index>(places.size()));
    for (std::size_t i = 0; i < places.size(); ++i)
      shape[static_cast<Eigen::Index>(i)] = mode.shape(places[i].axis, places[i].node);
    if (!places.empty()) measured.shape = nearest_real(shape);
    data.modes.push_back(std::move(measured));
  }
  return data;
}

/// By frequency; numbers of modes must rise with it.
void sort_modes(ModalData& data) {
  const auto below = [](const MeasuredMode& a, const MeasuredMode& b) {
    return a.frequency_hz < b.frequency_hz;
  };
  if (!std::is_sorted(data.modes.begin(), data.modes.end(), below)) {
    std::stable_sort(data.modes.begin(), data.modes.end(), below);
    data.remarks.emplace_back("The file does not list its modes by frequency; they are sorted here.");
  }
  int last = 0;
  for (const MeasuredMode& mode : data.modes) {
    if (!mode.number) continue;
    if (*mode.number <= last)
      throw InputError({data.source},
                       fmt::format("mode {} at {:g} Hz stands above mode {}; expected numbers that rise with "
                                   "the frequency",
                                   *mode.number, mode.frequency_hz, last));
    last = *mode.number;
  }
}

}  // namespace

bool holds_modes(const std::filesystem::path& file) {
  return file.extension() == ".toml" || file.extension() == ".json" || holds_universal_modes(file);
}

ModalData read_modal_data(const std::filesystem::path& file, const Experiment& experiment) {
  ModalData data = file.extension() == ".json"   ? read_modal_json(file, experiment)
                   : holds_universal_modes(file) ? read_modes_uff(file, experiment)
                                                 : read_modes_toml(file, experiment);
  sort_modes(data);
  return data;
}

}  // namespace beamid::experiments
