#include "experiments/identify/sensing/sensing_record.hpp"

#include <cmath>

#include "experiments/identify/model_setting.hpp"
#include "experiments/rig/logged_test.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

bool is_at(const UnknownForce& force, const Channel& channel, const fem::Structure& structure) {
  if (channel.quantity != force.quantity) return false;
  if (force.quantity == Quantity::base_acceleration) return true;
  if (!structure.has_positions()) return channel.place == force.at;
  const double natural = fem::natural_point(structure).position;
  return std::abs(channel.position.value_or(natural) - force.position.value_or(natural)) <
         1e-9 * structure.extent();
}

Channel channel_of(const VirtualSensor& sensor) {
  return {sensor.quantity, sensor.name, sensor.position, sensor.distance, sensor.at};
}

Channel channel_of(const UnknownForce& force) {
  return {force.quantity, force.name, force.position, 0.0, force.at};
}

}  // namespace

SensingRecord sensing_record(const Experiment& experiment, const Record& record, const Place& place) {
  SensingRecord result;
  result.sensors.resize(experiment.virtual_sensors.size());
  result.forces.resize(experiment.unknown_forces.size());
  std::vector<Index> outputs = output_channels(record), inputs;
  if (outputs.empty()) throw InputError(place, "the record has no motion; expected a sensor's channel");
  for (const Index i : input_channels(record)) {
    bool known = true;
    for (std::size_t j = 0; j < experiment.unknown_forces.size(); ++j)
      if (is_at(experiment.unknown_forces[j], record.channels[static_cast<std::size_t>(i)],
                experiment.structure)) {
        result.forces[j] = record.samples.row(i);
        known = false;
      }
    if (known) inputs.push_back(i);
  }
  result.measured = static_cast<Index>(outputs.size());
  const auto virtuals = static_cast<Index>(experiment.virtual_sensors.size()),
             unknown = static_cast<Index>(experiment.unknown_forces.size()),
             known = static_cast<Index>(inputs.size());
  Record& all = result.record;
  all = record;
  all.channels.clear();
  all.samples.setConstant(result.measured + virtuals + known + unknown, record.size(), std::nan(""));
  const auto take = [&](const std::vector<Index>& rows) {
    for (const Index i : rows) {
      all.samples.row(static_cast<Index>(all.channels.size())) = record.samples.row(i);
      all.channels.push_back(record.channels[static_cast<std::size_t>(i)]);
    }
  };
  take(outputs);
  for (const VirtualSensor& sensor : experiment.virtual_sensors) all.channels.push_back(channel_of(sensor));
  take(inputs);
  for (const UnknownForce& force : experiment.unknown_forces) all.channels.push_back(channel_of(force));
  all.samples.bottomRows(unknown).setZero();
  return result;
}

SensingRecord simulated_sensing(const Experiment& experiment, const std::filesystem::path& folder,
                                const Place& place, const Progress& progress) {
  Experiment test = experiment;
  if (test.sensors.empty()) {
    test.sensors.resize(2);
    test.sensors[0].quantity = Quantity::displacement;
  }
  const std::size_t own = test.sensors.size();
  for (const VirtualSensor& sensor : experiment.virtual_sensors)
    test.sensors.push_back({sensor.name, sensor.position, sensor.quantity, 0.0, sensor.distance, sensor.at});
  const Record whole = logged_test(test, folder, "simulated", progress).record;
  Record seen = whole;
  seen.channels.clear();
  std::vector<Index> rows;
  for (std::size_t i = 0; i < whole.channels.size(); ++i) {
    if (i >= own && i < test.sensors.size()) continue;
    rows.push_back(static_cast<Index>(i));
    seen.channels.push_back(whole.channels[i]);
    if (i < own) seen.channels.back().noise = test.sensors[i].noise;
  }
  seen.samples = whole.samples(rows, Eigen::all);
  SensingRecord result = sensing_record(experiment, seen, place);
  for (std::size_t i = own; i < test.sensors.size(); ++i)
    result.sensors[i - own] = whole.samples.row(static_cast<Index>(i));
  return result;
}

}  // namespace beamid::experiments
