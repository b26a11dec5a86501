#include "experiments/identify/engine/model_setting.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "experiments/config/readers.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/models/structure_points.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/signal/decimation.hpp"
#include "experiments/signal/onsets.hpp"
#include "experiments/signal/toolbox.hpp"
#include "experiments/text/choice.hpp"
#include "fem/parametric_system.hpp"
#include "filters/noise_estimation.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double unevenness = 0.01;  // of the mean interval

// Paths of the lower degree, with these inputs from the higher (m (d + 1) x N).
MatrixXd with_smooth_rows(const MatrixXd& low, const MatrixXd& smooth, Index inputs,
                          const std::vector<Index>& rows) {
  MatrixXd paths = MatrixXd::Zero(smooth.rows(), smooth.cols());
  paths.topRows(low.rows()) = low;
  for (const Index row : rows)
    for (Index j = row; j < smooth.rows(); j += inputs) paths.row(j) = smooth.row(j);
  return paths;
}

}  // namespace

const char* to_string(InputPath path) {
  switch (path) {
    case InputPath::band_limited:
      return "band_limited";
    case InputPath::linear:
      return "linear";
    case InputPath::held:
      return "held";
  }
  return "";
}

std::vector<Index> imposed_inputs(const Record& record) {
  const std::vector<Index> inputs = input_channels(record);
  std::vector<Index> imposed;
  for (std::size_t i = 0; i < inputs.size(); ++i)
    if (is_imposed(record.channels[static_cast<std::size_t>(inputs[i])].quantity))
      imposed.push_back(static_cast<Index>(i));
  return imposed;
}

RecordInputs take_inputs(const MatrixXd& samples, std::optional<InputPath> stated, filters::Measurements& to,
                         const std::vector<Index>& imposed) {
  if (const Index missing = samples.size() - samples.array().isFinite().count(); missing > 0)
    throw std::invalid_argument(
        fmt::format("{} readings of measured inputs are missing or not finite. The motion depends on every "
                    "one; expected all of them, or [record] missing_input = \"leave_out\" or \"zero\"",
                    missing));
  RecordInputs result{stated.value_or(InputPath::linear), stated.has_value(), to.size() - 1, 0};
  const bool held = stated == InputPath::held;
  to.inputs = held ? samples : filters::straight_path(samples).columns;
  const bool all_stated = stated && stated != InputPath::band_limited;
  if ((all_stated && imposed.empty()) || result.steps < 1) return result;
  const filters::InputPaths smooth =
      filters::band_limited_path(to.time, samples, unevenness * to.interval() + 2.0 * to.time_resolution);
  if (stated == InputPath::band_limited && smooth.band_limited == 0)
    throw std::invalid_argument(
        "input is 'band_limited', and no stamps are even; expected 'linear', or a record that is resampled "
        "first");
  if (stated != InputPath::band_limited && 2 * smooth.band_limited < result.steps) return result;
  if (all_stated) {
    to.inputs = with_smooth_rows(to.inputs, smooth.columns, samples.rows(), imposed);
    return result;
  }
  to.inputs = smooth.columns;
  result.path = InputPath::band_limited;
  result.straight = result.steps - smooth.band_limited;
  return result;
}

filters::InputPaths decimated_inputs(const filters::Measurements& from, Index inputs, int factor,
                                     const Eigen::VectorXd& time) {
  if (from.inputs.size() == 0 || inputs == 0) return {};
  const auto degree = static_cast<int>(from.inputs.rows() / inputs) - 1;
  const double interval = (time[time.size() - 1] - time[0]) / static_cast<double>(time.size() - 1);
  return filters::input_path(degree, time, decimate_channels(from.inputs.topRows(inputs), factor),
                             unevenness * interval);
}

std::optional<RecordInputs> record_inputs(const Record& record) {
  const std::vector<Index> forces = input_channels(record);
  if (forces.empty()) return {};
  filters::Measurements unused;
  unused.time = record.time;
  if (record.time_resolution < 0.5 * record.interval()) unused.time_resolution = record.time_resolution;
  return take_inputs(record.samples(forces, Eigen::all), record.input_path, unused, imposed_inputs(record));
}

std::string words(const RecordInputs& inputs) {
  std::string how;
  switch (inputs.path) {
    case InputPath::band_limited:
      how = "band-limited between their samples, as an anti-aliased converter records them";
      break;
    case InputPath::linear:
      how = "straight between their samples";
      break;
    case InputPath::held:
      how = "held, each sample until the next, and so late by half an interval";
      break;
  }
  std::string gaps;
  if (inputs.straight > 0)
    gaps = fmt::format("; straight over {} of {} intervals, at uneven stamps", inputs.straight, inputs.steps);
  return fmt::format("Measured inputs are taken as {}{} (input = \"{}\"{}).", how, gaps,
                     to_string(inputs.path), inputs.stated ? "" : ", chosen by the stamps");
}

VectorXd noise_before_event(const Record& record) {
  const Record whole = analysable(record).record;
  constexpr Index fewest = 32;
  constexpr double normal_consistency = 1.4826;  // of the median absolute deviation
  Index quiet = whole.size();
  bool any = false;
  for (Index i = 0; i < whole.samples.rows(); ++i) {
    const Onsets onsets = find_onsets(whole.samples.row(i).transpose(), whole.interval());
    if (onsets.samples.empty()) continue;
    any = true;
    quiet = std::min(quiet, onsets.quiet);
  }
  if (!any || quiet < fewest)
    throw std::invalid_argument(
        "noise.method is before_event, but " +
        (any ? "only " + std::to_string(quiet) + " samples lie before the record's first event"
             : std::string("the record has no event that begins from rest")) +
        "; expected 32 at least. residual and likelihood need none");
  VectorXd noise(static_cast<Index>(output_channels(whole).size()));
  Index k = 0;
  for (const Index i : output_channels(whole)) {
    const VectorXd part = whole.samples.row(i).head(quiet).transpose();
    noise[k++] = normal_consistency * median((part.array() - median(part)).abs());
  }
  return noise;
}

LikeliestNoise likeliest_noise(const Experiment& experiment, const Record& record, const JointModel& model,
                               const IdentificationSettings& settings, const filters::Gaussian& last) {
  const std::vector<Index> channels = output_channels(record);
  std::map<Quantity, std::vector<Index>> groups;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const Channel& channel = record.channels[static_cast<std::size_t>(channels[i])];
    if (!experiment.noise.contains(channel.quantity) && !(channel.noise > 0.0))
      groups[channel.quantity].push_back(static_cast<Index>(i));
  }
  if (groups.empty())
    throw std::invalid_argument("noise.method is likelihood, but the noise of every channel is stated");
  const Index states = settings.initial.mean.size();
  filters::NoiseSettings search;
  search.guess = {Eigen::MatrixXd::Zero(states, states), settings.output_noise};
  search.output_groups.clear();
  for (const auto& [quantity, members] : groups) search.output_groups.push_back(members);
  search.max_iterations = 50;
  const filters::NoiseEstimate estimate = filters::estimate_noise(
      [&](const filters::Noise& noise) {
        return filters::filter_registry().make(
            settings.filter, settings.filter_options,
            filters::discretise(model.motion, record.interval(), settings.discretisation, noise));
      },
      next_start(model, settings.initial, last), measurements(record), search);
  if (estimate.status == filters::NoiseStatus::failed)
    throw std::invalid_argument("noise.method is likelihood, but the search for it failed: " +
                                estimate.reason);
  LikeliestNoise found{estimate.noise.output.diagonal().cwiseSqrt(), {}};
  found.relative_deviation = VectorXd::Zero(found.deviation.size());
  Index group = 0;
  for (const auto& [quantity, members] : groups) {
    for (const Index i : members) found.relative_deviation[i] = estimate.relative_deviations[group];
    ++group;
  }
  return found;
}

namespace {

std::vector<Index> channels_where(const Record& record, bool input) {
  std::vector<Index> found;
  for (std::size_t i = 0; i < record.channels.size(); ++i)
    if (is_input(record.channels[i].quantity) == input) found.push_back(static_cast<Index>(i));
  return found;
}

// Nodes where strain is read, and where a region begins or ends: rows of this mesh then fit that of the
// model.
fem::Structure with_nodes_for(const Experiment& experiment, const Record& record) {
  if (!experiment.structure.is_beam()) return experiment.structure;
  const fem::Beam& beam = experiment.structure.beam();
  std::vector<double> nodes;
  for (const Channel& channel : record.channels)
    if (channel.quantity == Quantity::strain)
      nodes.push_back(channel.position.value_or(fem::natural_point(beam).position));
  for (const ParameterChoice& parameter : experiment.parameters)
    if (parameter.region && parameter.quantity == "bending_stiffness")
      nodes.insert(nodes.end(), {parameter.region->first, parameter.region->second});
  return nodes.empty() ? beam : fem::with_nodes(beam, nodes);
}

// What the channels of one quantity show at their places: accelerations have the shapes of displacements.
reduction::Training seen_shapes(const Record& record, const fem::Beam& beam) {
  std::vector<Index> alike;
  for (const Index i : channels_where(record, false))
    if (record.channels[i].quantity == record.channels[channels_where(record, false)[0]].quantity)
      alike.push_back(i);
  reduction::Training training;
  training.positions.resize(static_cast<Index>(alike.size()));
  for (std::size_t i = 0; i < alike.size(); ++i)
    training.positions[static_cast<Index>(i)] =
        record.channels[alike[i]].position.value_or(fem::natural_point(beam).position);
  training.deflections = record.samples(alike, Eigen::all);
  return training;
}

}  // namespace

std::vector<Index> output_channels(const Record& record) {
  return channels_where(record, false);
}
std::vector<Index> input_channels(const Record& record) {
  return channels_where(record, true);
}

filters::Measurements measurements(const Record& record) {
  if (!record.own_clock.empty())
    throw std::invalid_argument(
        "channels with a clock of their own ([record] own_clock): identify and compare find their lags; "
        "expected one clock, or the step shift for lags that are known");
  const std::vector<Index> outputs = output_channels(record), forces = input_channels(record);
  filters::Measurements result{record.time, record.samples(outputs, Eigen::all), {}};
  if (record.time_resolution < 0.5 * record.interval()) result.time_resolution = record.time_resolution;
  if (!forces.empty())
    take_inputs(record.samples(forces, Eigen::all), record.input_path, result, imposed_inputs(record));
  return result;
}

ModelSetting model_setting(const Experiment& experiment, const Record& record, const Choice& reduction,
                           const std::filesystem::path& folder) {
  require_model_of_storeys(experiment);
  ModelSetting setting;
  const fem::Structure structure = with_nodes_for(experiment, record);
  StructurePoints points(structure);
  const std::vector<Index> channels = output_channels(record);
  std::vector<Index> rows;  // output of the system that a channel reads; a strain gauge has one of its own
  for (const Index i : channels) {
    const Channel& channel = record.channels[i];
    rows.push_back(channel.quantity == Quantity::strain
                       ? -1
                       : points.add(channel.position, channel.place, is_angular(channel.quantity)));
    setting.observations.push_back({channel.quantity, channel.name});
  }
  const std::vector<Index> inputs = input_channels(record);
  for (const Index i : inputs) {
    const Channel& channel = record.channels[i];
    if (is_imposed(channel.quantity)) setting.supports.push_back(static_cast<Index>(setting.forces.size()));
    setting.forces.push_back(channel.quantity == Quantity::base_acceleration
                                 ? -1
                                 : points.add(channel.position, channel.place, is_angular(channel.quantity)));
  }
  setting.system = fem::assemble(structure, experiment.elements, points.all());
  const Index base = setting.system.inputs.cols() - 1;
  if (std::count(setting.forces.begin(), setting.forces.end(), Index{-1}) > 1)
    throw std::invalid_argument(
        "the record holds several channels of base_acceleration; expected one, of all supports together");
  if (std::count(setting.forces.begin(), setting.forces.end(), Index{-1}) == 1 &&
      !setting.system.is_moved_by_base())
    throw std::invalid_argument(
        "the record holds the acceleration of the base, which does not move the structure; expected "
        "base_motion in [system]");
  std::replace(setting.forces.begin(), setting.forces.end(), Index{-1}, base);

  const MatrixXd deflections = MatrixXd(setting.system.outputs);
  MatrixXd outputs(static_cast<Index>(rows.size()), setting.system.size());
  std::vector<std::string> names;
  Eigen::VectorXd base_shares = Eigen::VectorXd::Ones(outputs.rows());
  for (Index i = 0; i < outputs.rows(); ++i) {
    const Channel& channel = record.channels[channels[i]];
    if (rows[i] >= 0) {
      outputs.row(i) = deflections.row(rows[i]);
      if (setting.system.base_shares.size() > 0) base_shares[i] = setting.system.base_shares[rows[i]];
      names.push_back(setting.system.output_names[rows[i]]);
    } else {
      const double position = channel.position.value_or(fem::natural_point(structure).position);
      outputs.row(i) =
          -channel.distance * MatrixXd(fem::gauge_row(setting.system, structure.beam(), position));
      names.push_back(channel.name + "_strain");
    }
  }
  setting.system.outputs = outputs.sparseView();
  setting.system.output_names = names;
  setting.system.base_shares = base_shares;
  setting.damping = experiment.damping;
  setting.parameters = experiment.parameters;
  setting.prior = experiment.prior;
  setting.storey_springs = experiment.storey_springs;
  setting.continuum = ModelSetting::Continuum{structure, experiment.elements, points.all()};
  at_place(reduction.place, [&] {
    setting.reduction = reduction::reduction_registry().make(reduction.name, reduction.options);
  });
  if (!reduction.shape_file.empty())
    setting.training = read_shape(folder / reduction.shape_file, experiment.structure.beam().length());
  const auto response = reduction.options.values().find("response");
  if (response != reduction.options.values().end() &&
      response->second == filters::OptionValue(std::string("record")))
    setting.training = seen_shapes(record, experiment.structure.beam());
  return setting;
}

}  // namespace beamid::experiments
