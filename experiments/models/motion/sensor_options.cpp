#include "experiments/models/motion/sensor_options.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace beamid::experiments {

std::vector<filters::OptionSpec> sensor_options() {
  return {{"sensor_bias", true, "",
           "estimate the constant offset of every accelerometer too, where acceleration is observed"},
          {"sensor_drift", false, "", "and the rate at which it drifts"}};
}

Eigen::VectorXd base_shares(const fem::StructuralSystem& system) {
  const auto outputs = system.outputs.rows();
  return system.base_shares.size() == outputs ? system.base_shares : Eigen::VectorXd::Ones(outputs);
}

MotionDescription describe_sensors(const std::string& model, const ModelSetting& setting,
                                   const filters::Options& options) {
  MotionDescription description;
  description.observations = setting.observations;
  if (setting.observations.empty())
    throw std::invalid_argument("model '" + model + "' needs at least one observed quantity");
  for (const Observation& observation : setting.observations)
    if (is_input(observation.quantity))
      throw std::invalid_argument("model '" + model +
                                  "' observes displacement, velocity, acceleration or strain; found " +
                                  to_string(observation.quantity));
  const auto rows = setting.system.outputs.rows();
  if (rows != static_cast<Eigen::Index>(setting.observations.size()))
    throw std::invalid_argument(
        fmt::format("the system has {} outputs for {} observations; expected one each", rows,
                    setting.observations.size()));
  for (Eigen::Index i = 0; i < rows; ++i)
    if (Eigen::MatrixXd(setting.system.outputs.row(i)).isZero(0.0))
      throw std::invalid_argument(fmt::format(
          "observation {} of {} reads nothing of the motion; expected a place that moves, and of a "
          "strain gauge its place and its distance from the axis",
          i + 1, to_string(setting.observations[static_cast<std::size_t>(i)].quantity)));
  description.forces = setting.forces;
  for (std::size_t i = 0; i < setting.forces.size(); ++i) {
    const Eigen::Index input = setting.forces[i];
    if (input < 0 || input >= setting.system.inputs.cols())
      throw std::invalid_argument(
          fmt::format("input {} of the system; expected 0 to {}", input, setting.system.inputs.cols() - 1));
    const auto& names = setting.system.input_names;
    if (input < static_cast<Eigen::Index>(names.size()) &&
        names[static_cast<std::size_t>(input)] == "base_acceleration")
      description.base = static_cast<Eigen::Index>(i);
  }
  description.carried.setZero(rows, static_cast<Eigen::Index>(setting.forces.size()));
  if (description.base >= 0) description.carried.col(description.base) = base_shares(setting.system);
  description.sensor_bias = options.flag("sensor_bias");
  description.sensor_drift = options.flag("sensor_drift");
  if (description.sensor_drift && !description.sensor_bias)
    throw std::invalid_argument("sensor_drift is true and sensor_bias false; expected both, or no drift");
  return description;
}

}  // namespace beamid::experiments
