#include "experiments/models/motion/parametric_motion.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace beamid::experiments {

using Eigen::Index, Eigen::VectorXd;

ModeDamping damping_at(const DampedMode& mode, const VectorXd& change, double ratio) {
  const double mass = 1.0 + mode.mass_slopes.dot(change);
  const double stiffness = mode.stiffness + mode.stiffness_slopes.dot(change);
  if (!(mass > 0.0 && stiffness > 0.0))
    throw std::runtime_error(fmt::format(
        "the parameters give a damped mode {:g} of its mass and {:g} of its stiffness; expected both above 0",
        mass, stiffness / mode.stiffness));
  // c = 2 xi sqrt(kappa) mu^(-3/2)
  ModeDamping at;
  at.by_ratio = 2.0 * std::sqrt(stiffness / mass) / mass;
  at.factor = ratio * at.by_ratio;
  at.by_property = at.factor * (0.5 / stiffness * mode.stiffness_slopes - 1.5 / mass * mode.mass_slopes);
  at.momentum = mode.momentum + mode.momentum_slopes * change;
  return at;
}

StateLayout layout(const MotionDescription& description, Index coordinates) {
  StateLayout result;
  result.coordinates = coordinates;
  const auto count = description.observations.size();
  result.biases.assign(count, -1);
  result.drifts.assign(count, -1);
  Index next = 2 * coordinates;
  const auto place_offsets = [&] {
    for (std::size_t i = 0; i < count; ++i) {
      if (description.observations[i].quantity != Quantity::acceleration) continue;
      const auto channel = static_cast<Index>(i);
      result.biases[i] = next++;
      result.offsets.push_back({result.biases[i], channel, false});
      if (!description.sensor_drift) continue;
      result.drifts[i] = next++;
      result.offsets.push_back({result.drifts[i], channel, true});
    }
  };
  if (description.sensor_bias && description.sensor_drift) place_offsets();
  result.motion = next;
  result.unknowns = next;
  next += static_cast<Index>(description.unknowns.size());
  if (description.sensor_bias && !description.sensor_drift) place_offsets();
  result.size = next;
  return result;
}

filters::Label state_label(const Unknown& unknown) {
  if (unknown.form == Form::linear) return {unknown.name, unknown.unit.empty() ? "1" : unknown.unit};
  return {(unknown.form == Form::logarithmic ? "ln_" : "logit_") + unknown.name, "1"};
}

std::vector<filters::Label> state_labels(const MotionDescription& description, const StateLayout& layout,
                                         const std::string& name) {
  std::vector<filters::Label> labels(static_cast<std::size_t>(layout.size));
  const auto n = static_cast<std::size_t>(layout.coordinates);
  for (std::size_t i = 0; i < n; ++i) {
    labels[i] = {fmt::format("{}_{}", name, i + 1), "m"};
    labels[n + i] = {fmt::format("{}_{}_rate", name, i + 1), "m/s"};
  }
  for (std::size_t j = 0; j < description.unknowns.size(); ++j)
    labels[static_cast<std::size_t>(layout.unknowns) + j] = state_label(description.unknowns[j]);
  const bool several = layout.offsets.size() > (description.sensor_drift ? 2u : 1u);
  for (const JointModel::Offset& offset : layout.offsets) {
    const std::string which = several ? fmt::format("_{}", offset.channel + 1) : "";
    labels[static_cast<std::size_t>(offset.place)] = offset.drift
                                                         ? filters::Label{"sensor_drift" + which, "m/s3"}
                                                         : filters::Label{"sensor_bias" + which, "m/s2"};
  }
  return labels;
}

std::vector<filters::Label> output_labels(const MotionDescription& description) {
  std::vector<filters::Label> labels;
  for (const Observation& observation : description.observations)
    labels.push_back({to_string(observation.quantity), si_unit(observation.quantity)});
  return labels;
}

PhysicalValues physical_values(const MotionDescription& description, const StateLayout& layout,
                               const VectorXd& state) {
  const auto q = static_cast<Index>(description.unknowns.size());
  PhysicalValues at{VectorXd(q),
                    VectorXd(q),
                    VectorXd::Zero(description.properties()),
                    VectorXd(static_cast<Index>(description.damped_modes.size())),
                    description.mass_damping,
                    description.stiffness_damping};
  for (Index j = 0; j < q; ++j) {
    const Unknown& unknown = description.unknowns[static_cast<std::size_t>(j)];
    const double eta = state[layout.unknowns + j];
    at.values[j] = unknown.to_physical(eta);
    at.slopes[j] = unknown.slope(eta);
    const Drive& drive = description.drives[static_cast<std::size_t>(j)];
    if (drive.kind == Drive::Kind::property)
      at.change[drive.index] = at.values[j] - description.reference[drive.index];
    if (drive.kind == Drive::Kind::mass_damping) at.mass_damping = at.values[j];
    if (drive.kind == Drive::Kind::stiffness_damping) at.stiffness_damping = at.values[j];
  }
  for (Index i = 0; i < at.ratios.size(); ++i) {
    const DampedMode& mode = description.damped_modes[static_cast<std::size_t>(i)];
    at.ratios[i] = mode.unknown < 0 ? mode.ratio : at.values[mode.unknown];
  }
  return at;
}

Reads reads(Quantity quantity) {
  if (quantity == Quantity::velocity) return Reads::rates;
  if (quantity == Quantity::acceleration || quantity == Quantity::angular_acceleration)
    return Reads::accelerations;
  if (is_input(quantity))
    throw std::invalid_argument(
        "an input is no observation of the motion; expected displacement, velocity, acceleration or strain");
  return Reads::coordinates;
}

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
          "observation {} of {} reads no part of the motion; expected a place that moves, and of a "
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
