#include "experiments/identify/bounds/described_motion.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "experiments/identify/bounds/identifiability.hpp"
#include "experiments/identify/engine/identified_parameters.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/verdict/reproduction.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/models/structure_points.hpp"
#include "experiments/rig/simulated_test.hpp"
#include "experiments/rig/virtual_rig.hpp"
#include "experiments/text/choice.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

std::vector<Index> record_lengths(double samples_per_period, Index described, Index most) {
  constexpr double few_periods = 3.0, same = 0.05;
  constexpr int count = 16;
  const double least =
      std::max(8.0, std::min(few_periods * samples_per_period, static_cast<double>(described) / 4.0));
  std::vector<Index> lengths{described};
  for (int i = 0; i <= count; ++i) {
    const double length = least * std::pow(static_cast<double>(most) / least, static_cast<double>(i) / count);
    if (std::abs(length / static_cast<double>(described) - 1.0) > same)
      lengths.push_back(static_cast<Index>(std::llround(length)));
  }
  std::sort(lengths.begin(), lengths.end());
  lengths.erase(std::unique(lengths.begin(), lengths.end()), lengths.end());
  return lengths;
}

std::vector<Index> strides(double samples_per_period, Index samples) {
  constexpr double fewest_per_period = 2.1;  // at 2 all samples may fall on zeros
  constexpr Index fewest_samples = 16;
  std::vector<Index> found{1};
  for (Index decade = 1;; decade *= 10)
    for (const Index step : {2 * decade, 5 * decade, 10 * decade}) {
      if (samples_per_period < fewest_per_period * static_cast<double>(step) ||
          samples < fewest_samples * step)
        return found;
      found.push_back(step);
    }
}

MatrixXd bounds_percent(const ObservedMotion& motion, const std::vector<ChannelInformation>& records,
                        const std::vector<NoisyChannel>& channels) {
  MatrixXd percent(static_cast<Index>(records.size()), static_cast<Index>(motion.model.unknowns.size()));
  for (std::size_t i = 0; i < records.size(); ++i)
    percent.row(static_cast<Index>(i)) =
        100.0 * relative_bounds(information_about_unknowns(motion, records[i], channels)).transpose();
  return percent;
}

MatrixXd bounds_percent_alone(const ObservedMotion& motion, const ChannelInformation& record,
                              const std::vector<NoisyChannel>& channels) {
  MatrixXd percent(static_cast<Index>(channels.size()), static_cast<Index>(motion.model.unknowns.size()));
  for (std::size_t i = 0; i < channels.size(); ++i)
    percent.row(static_cast<Index>(i)) =
        100.0 * relative_bounds(information_about_unknowns(motion, record, {channels[i]})).transpose();
  return percent;
}

std::vector<AddedChannel> add_best(const ObservedMotion& motion, const ChannelInformation& record,
                                   std::vector<NoisyChannel> channels,
                                   const std::vector<NoisyChannel>& candidates, int count) {
  const auto q = static_cast<Index>(motion.model.unknowns.size());
  std::vector<AddedChannel> added;
  for (int i = 0; i < count; ++i) {
    std::optional<AddedChannel> best;
    Index most_determined = -1;
    double largest = 0.0;
    for (std::size_t candidate = 0; candidate < candidates.size(); ++candidate) {
      if (std::any_of(added.begin(), added.end(),
                      [&](const AddedChannel& other) { return other.candidate == candidate; }))
        continue;
      channels.push_back(candidates[candidate]);
      const auto report = filters::determined_combinations(
          information_about_unknowns(motion, record, channels), VectorXd::Ones(q));
      channels.pop_back();
      const double logarithm = report.eigenvalues.head(report.rank).array().log().sum();
      if (report.rank < most_determined || (report.rank == most_determined && !(logarithm > largest)))
        continue;
      most_determined = report.rank;
      largest = logarithm;
      best = AddedChannel{candidate, 100.0 * report.bounds};
    }
    if (!best) break;
    channels.push_back(candidates[best->candidate]);
    added.push_back(std::move(*best));
  }
  return added;
}

namespace {

// Where a model's motion begins when the continuum begins as described.

inline constexpr Eigen::Index fewest_start_samples = 64;  ///< from which a start is found

/// The start from which the model follows best what the continuum does in as many modes as the model has: of
/// further modes a start would make the best of, each set of sensors another. The sensors' offsets are zero.
/// Under the forces that the motion's inputs hold.
/// @param motion all but the start.
/// @param begin first sample that the model follows.
Eigen::VectorXd model_start(const ObservedMotion& motion, Experiment experiment,
                            const std::filesystem::path& folder, const std::vector<Sensor>& sensors,
                            Eigen::Index begin, const Progress& progress);

constexpr double start_periods = 5.0;  // of mode 1, over which the start of the model's motion is found

double slowest_period(const JointModel& model) {
  for (const double omega : model.mode_frequencies)
    if (omega > 0.0) return 2.0 * std::numbers::pi / omega;
  return 0.0;
}

/// Sensors of the same quantity count alike, quantities by the largest motion that one of them shows.
MatrixXd weights(const std::vector<Sensor>& sensors, const MatrixXd& outputs) {
  const VectorXd size = outputs.rowwise().norm();
  VectorXd variances = VectorXd::Ones(size.size());
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    double largest = 0.0;
    for (std::size_t j = 0; j < sensors.size(); ++j)
      if (sensors[j].quantity == sensors[i].quantity)
        largest = std::max(largest, size[static_cast<Index>(j)]);
    if (largest > 0.0) variances[static_cast<Index>(i)] = largest * largest;
  }
  return variances.asDiagonal();
}

/// The continuum as described, seen by these sensors without their noise; behind them in the record what
/// drives it, in the order of the file.
SimulatedTest clean_test(const Experiment& experiment, const std::filesystem::path& folder,
                         const std::vector<Sensor>& sensors, double duration, const Progress& progress) {
  Experiment clean = experiment;
  clean.sensors = sensors;
  for (Sensor& sensor : clean.sensors) sensor.noise = 0.0;
  clean.simulation.duration = duration;
  return simulate(clean, folder, 0, progress);
}

VectorXd model_start(const ObservedMotion& motion, Experiment experiment, const std::filesystem::path& folder,
                     const std::vector<Sensor>& sensors, Index begin, const Progress& progress) {
  const double rate = 1.0 / motion.interval;
  constexpr double most_samples = 2e5;
  const double period = slowest_period(motion.model), needed = std::ceil(start_periods * period * rate);
  if (!(needed < most_samples))
    throw std::invalid_argument(fmt::format(
        "{:g} periods of the first mode, of {:.3g} s each, are {:.3g} samples at {:g} Hz; expected at most "
        "{:g}. Lower simulation.sampling_rate_hz, or check that the beam is described in SI units",
        start_periods, period, needed, rate, most_samples));
  const Index samples = std::max(fewest_start_samples, static_cast<Index>(needed));
  if (experiment.simulation.method.name == "modal")
    experiment.simulation.method.options["modes"] = static_cast<double>(motion.model.mode_shapes.cols());
  const Record record =
      clean_test(experiment, folder, sensors, static_cast<double>(begin + samples) / rate, progress).record;
  const auto channels = static_cast<Index>(sensors.size());
  const MatrixXd all = record.samples.middleCols(begin, samples), outputs = all.topRows(channels);
  const auto discrete = filters::discretise(motion.model.motion, motion.interval, motion.discretisation,
                                            {{}, weights(sensors, outputs)});
  filters::Measurements part{record.time.segment(begin, samples), outputs, {}};
  if (motion.inputs.size() > 0)
    take_inputs(all.bottomRows(all.rows() - channels), experiment.format.input, part);
  VectorXd state =
      (is_nonlinear(motion.model)
           ? reproduce_nonlinear(motion.model, *discrete, motion.initial_state, motion.directions, part)
           : reproduce(*discrete, motion.initial_state, motion.directions, part))
          .initial_state;
  for (const JointModel::Offset& offset : motion.model.offsets) state[offset.place] = 0.0;
  return state;
}

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
                       "the force acts until the record ends; a record without it shows no motion");
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
