#include "experiments/config/read_modal_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "experiments/modal/nearest_real.hpp"
#include "experiments/results/results.hpp"
#include "experiments/text/json_file.hpp"

namespace beamid::experiments {
namespace {

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
      data.warnings.push_back(message.value("text", ""));
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

}  // namespace

ModalData read_modal_json(const std::filesystem::path& file, const Experiment& experiment) {
  const Json json = read_json(file, "the results of beamid modal");
  try {
    return modes_in(json, file, experiment);
  } catch (const Json::exception& error) {
    throw InputError({file.string()}, std::string("not as beamid modal writes it: ") + error.what() +
                                          "; expected its results.json as it is");
  }
}

}  // namespace beamid::experiments
