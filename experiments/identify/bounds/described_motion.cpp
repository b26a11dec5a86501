#include "experiments/identify/bounds/described_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/identify/bounds/model_start.hpp"
#include "experiments/identify/compare/true_value.hpp"
#include "experiments/identify/model_setting.hpp"
#include "experiments/identify/record_inputs.hpp"
#include "experiments/models/finest_discretisation.hpp"
#include "experiments/models/structure_points.hpp"
#include "experiments/rig/excitation_history.hpp"
#include "experiments/text/method_choice.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using Kind = Excitation::Kind;

constexpr double usual_displacement = 1e-3;  // [m]; only a unit, for the start is eliminated

/// The force histories of a test, of forces and of the base, in the order of the file.
std::vector<const Excitation*> forces_of(const Experiment& experiment) {
  std::vector<const Excitation*> forces;
  if (has_force_history(experiment.excitation)) forces.push_back(&experiment.excitation);
  for (const Excitation& further : experiment.further_excitations)
    if (has_force_history(further)) forces.push_back(&further);
  return forces;
}

/// @param forces that are measured too, a channel of each
ModelSetting setting_of(const Experiment& experiment, const std::vector<Sensor>& sensors,
                        const std::vector<const Excitation*>& forces) {
  Record record;
  for (const Sensor& sensor : sensors)
    record.channels.push_back({sensor.quantity, sensor.name, sensor.position, sensor.distance, sensor.place});
  for (const Excitation* const force : forces)
    record.channels.push_back(force->kind == Kind::base
                                  ? Channel{Quantity::base_acceleration, "base_acceleration"}
                                  : Channel{Quantity::force, "force", force->position, 0.0, force->at});
  return model_setting(experiment, record, experiment.reduction);
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

struct ForceHistories {
  MatrixXd values;                   ///< at the samples, in the order of forces_of() (m x N)
  Index begin = 0;                   ///< of a record without them: the first sample after all have ended
  const Excitation* last = nullptr;  ///< that ends there
};

/// On the points of simulate(), so that random forces draw from the same streams.
ForceHistories force_histories(const Experiment& experiment, const std::filesystem::path& folder,
                               const std::vector<Sensor>& sensors, Index samples) {
  StructurePoints points(experiment.structure);
  for (const Sensor& sensor : sensors)
    if (sensor.quantity != Quantity::strain) points.add(sensor.position, sensor.place);
  std::vector<const Excitation*> all{&experiment.excitation};
  for (const Excitation& further : experiment.further_excitations) all.push_back(&further);
  std::vector<Index> inputs;
  for (const Excitation* const one : all) inputs.push_back(points.add(one->position, one->at));
  const fem::StructuralSystem system = fem::assemble(experiment.structure, experiment.elements, points.all());
  const Simulation& settings = experiment.simulation;
  const int steps = settings.steps_per_sample;
  const fem::TimeGrid grid{1.0 / (settings.sampling_rate * steps), (samples - 1) * steps + 1, {}};
  ForceHistories result;
  result.values.resize(static_cast<Index>(forces_of(experiment).size()), samples);
  Index row = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!has_force_history(*all[i])) continue;
    const ExcitationHistory history = excite(*all[i], system, inputs[i], grid, folder, settings.seed);
    const VectorXd fine = all[i]->kind == Kind::base ? history.base_acceleration
                                                     : VectorXd(history.loading.inputs.row(inputs[i]));
    const VectorXd sampled = fine(Eigen::seqN(Index{0}, samples, Index{steps}));
    result.values.row(row) = sampled.transpose();
    for (Index k = result.begin; k < samples; ++k)
      if (result.values(row, k) != 0.0) result.begin = k + 1, result.last = all[i];
    ++row;
  }
  return result;
}

}  // namespace

DescribedMotion described_motion(const Experiment& experiment, const std::filesystem::path& folder,
                                 const TestView& view, const Progress& progress) {
  const double rate = experiment.simulation.sampling_rate;
  const std::vector<const Excitation*> forces = forces_of(experiment);
  const bool known = !forces.empty() && view.force_measured;

  DescribedMotion result;
  const ModelSetting setting =
      setting_of(experiment, view.sensors, known ? forces : std::vector<const Excitation*>());
  ObservedMotion& motion = result.motion;
  motion.model = *at_place(experiment.model.place, [&] {
    return model_registry().make(experiment.model.name, experiment.model.options, setting);
  });
  motion.interval = 1.0 / rate;
  motion.discretisation = finest_discretisation(motion.model);
  motion.initial_state = described_state(experiment, motion.model);

  Index begin = 0;
  if (!forces.empty()) {
    const ForceHistories histories = force_histories(experiment, folder, view.sensors, view.samples);
    if (known) {
      filters::Measurements history;
      history.time =
          motion.interval * VectorXd::LinSpaced(view.samples, 0.0, static_cast<double>(view.samples - 1));
      result.inputs = take_inputs(histories.values, experiment.format.input, history);
      motion.inputs = history.inputs;
    } else {
      begin = histories.begin;
    }
    if (begin >= view.samples)
      throw InputError(histories.last->place,
                       "the force acts until the record ends; a record without it has nothing to show");
  }
  result.begin = static_cast<double>(begin) / rate;

  const double needed = static_cast<double>(begin + fewest_start_samples) / rate;
  const SimulatedTest test =
      clean_test(experiment, folder, view.sensors, std::max(view.simulated, needed), progress);
  result.sensors = test.sensors;
  const auto channels = static_cast<Index>(view.sensors.size());
  const MatrixXd shown = test.record.samples.topRightCorner(channels, test.record.size() - begin);
  result.root_mean_squares = (shown.rowwise().squaredNorm() / static_cast<double>(shown.cols())).cwiseSqrt();
  leave_out_rounding(test, result.root_mean_squares);
  StartScale scale =
      start_scale(motion.model, setting.observations, shown, static_cast<double>(view.samples) / rate);
  if (!(scale.displacement > 0.0)) scale.displacement = usual_displacement;
  motion.directions = start_directions(motion.model, setting.observations, scale);
  if (!known || !has_force_history(experiment.excitation))
    motion.initial_state = model_start(motion, experiment, folder, view.sensors, begin, progress);
  return result;
}

}  // namespace beamid::experiments
