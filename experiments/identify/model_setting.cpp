#include "experiments/identify/model_setting.hpp"

#include <algorithm>
#include <stdexcept>

#include "experiments/config/read_reduction.hpp"
#include "experiments/config/storey_laws.hpp"
#include "experiments/identify/record_inputs.hpp"
#include "experiments/models/structure_points.hpp"
#include "experiments/text/method_choice.hpp"
#include "fem/gauge_row.hpp"
#include "fem/parametric_system.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd;

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
