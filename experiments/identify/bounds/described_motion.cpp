#include "experiments/identify/bounds/described_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/identify/bounds/model_start.hpp"
#include "experiments/identify/compare/true_value.hpp"
#include "experiments/identify/model_setting.hpp"
#include "experiments/identify/record_inputs.hpp"
#include "experiments/models/finest_discretisation.hpp"
#include "experiments/rig/excitation_history.hpp"
#include "experiments/text/method_choice.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using Kind = Excitation::Kind;

constexpr double usual_displacement = 1e-3;  // [m]; only a unit, for the start is eliminated

/// @param forced the force, or the acceleration of the base, is measured too.
ModelSetting setting_of(const Experiment& experiment, const std::vector<Sensor>& sensors, bool forced) {
  const bool of_base = experiment.excitation.kind == Kind::base;
  Record record;
  for (const Sensor& sensor : sensors)
    record.channels.push_back({sensor.quantity, sensor.name, sensor.position, sensor.distance, sensor.place});
  if (forced && !of_base)
    record.channels.push_back(
        {Quantity::force, "force", experiment.excitation.position, 0.0, experiment.excitation.at});
  ModelSetting setting = model_setting(experiment, record, experiment.reduction);
  if (forced && of_base) setting.forces = {setting.system.inputs.cols() - 1};
  return setting;
}

/// The unknowns as described, all else zero.
VectorXd described_state(const Experiment& experiment, const JointModel& model) {
  VectorXd state = VectorXd::Zero(static_cast<Index>(model.motion->state_labels().size()));
  for (std::size_t j = 0; j < model.unknowns.size(); ++j) {
    const Unknown& unknown = model.unknowns[j];
    const double value = true_value(experiment, model.equivalent_mass, unknown).value_or(unknown.guess);
    double& entry = state[model.unknown_places[j]];
    try {
      entry = unknown.to_state(value);
    } catch (const std::invalid_argument&) {  // outside what the parameter's form allows
      entry = unknown.to_state(unknown.guess);
    }
  }
  return state;
}

/// Zero where a sensor reads 1e-9 of what the beam's other points do: a node of all that moves.
void leave_out_rounding(const SimulatedTest& test, VectorXd& root_mean_squares) {
  constexpr double rounding = 1e-9;
  for (std::size_t i = 0; i < test.sensors.size(); ++i) {
    const Quantity quantity = test.sensors[i].quantity;
    const MatrixXd& all = quantity == Quantity::displacement ? test.response.displacement
                          : quantity == Quantity::velocity   ? test.response.velocity
                                                             : test.response.acceleration;
    double& shown = root_mean_squares[static_cast<Index>(i)];
    if (quantity != Quantity::strain && shown < rounding * all.cwiseAbs().maxCoeff()) shown = 0.0;
  }
}

struct ForceHistory {
  VectorXd values;  ///< at the samples
  Index begin = 0;  ///< of a record without it: the first sample after it has ended
};

ForceHistory force_history(const Experiment& experiment, const std::filesystem::path& folder,
                           const ModelSetting& setting, Index samples) {
  const int steps = experiment.simulation.steps_per_sample;
  const double rate = experiment.simulation.sampling_rate;
  const Index input = setting.forces.front();
  const auto history = excite(experiment.excitation, setting.system, input,
                              {1.0 / (rate * steps), (samples - 1) * steps + 1, {}}, folder);
  ForceHistory force;
  const VectorXd fine = history.loading.inputs.row(input);
  force.values = fine(Eigen::seqN(Index{0}, samples, Index{steps}));
  for (Index k = 0; k < samples; ++k)
    if (force.values[k] != 0.0) force.begin = k + 1;
  return force;
}

}  // namespace

DescribedMotion described_motion(const Experiment& experiment, const std::filesystem::path& folder,
                                 const TestView& view, const Progress& progress) {
  const double rate = experiment.simulation.sampling_rate;
  const bool forced = has_force_history(experiment.excitation);
  const bool known = forced && view.force_measured;

  DescribedMotion result;
  ModelSetting setting = setting_of(experiment, view.sensors, known);
  ObservedMotion& motion = result.motion;
  motion.model = *at_place(experiment.model.place, [&] {
    return model_registry().make(experiment.model.name, experiment.model.options, setting);
  });
  motion.interval = 1.0 / rate;
  motion.discretisation = finest_discretisation(motion.model);
  motion.initial_state = described_state(experiment, motion.model);

  Index begin = 0;
  if (forced) {
    if (!known) setting = setting_of(experiment, view.sensors, true);
    const ForceHistory force = force_history(experiment, folder, setting, view.samples);
    if (known) {
      filters::Measurements history;
      history.time =
          motion.interval * VectorXd::LinSpaced(view.samples, 0.0, static_cast<double>(view.samples - 1));
      result.inputs = take_inputs(force.values.transpose(), experiment.format.input, history);
      motion.inputs = history.inputs;
    }
    if (!known) begin = force.begin;
    if (begin >= view.samples)
      throw InputError(experiment.excitation.place,
                       "the force acts until the record ends; a record without it has nothing to show");
  }
  result.begin = static_cast<double>(begin) / rate;

  const double needed = static_cast<double>(begin + fewest_start_samples) / rate;
  const SimulatedTest test =
      clean_test(experiment, folder, view.sensors, std::max(view.simulated, needed), progress);
  result.sensors = test.sensors;
  const MatrixXd shown = test.record.samples.rightCols(test.record.size() - begin);
  result.root_mean_squares = (shown.rowwise().squaredNorm() / static_cast<double>(shown.cols())).cwiseSqrt();
  leave_out_rounding(test, result.root_mean_squares);
  StartScale scale =
      start_scale(motion.model, setting.observations, shown, static_cast<double>(view.samples) / rate);
  if (!(scale.displacement > 0.0)) scale.displacement = usual_displacement;
  motion.directions = start_directions(motion.model, setting.observations, scale);
  if (!known) motion.initial_state = model_start(motion, experiment, folder, view.sensors, begin, progress);
  return result;
}

}  // namespace beamid::experiments
