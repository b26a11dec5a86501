
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

ModalData read_modal_data(const std::filesystem::path& file, const Experiment& experiment) {
  const bool json = file.extension() == ".json";
  ModalData data = json ? read_modal_json(file, experiment) : read_modes_toml(file, experiment);
  sort_modes(data);
  return data;
}

}  // namespace beamid::experiments
