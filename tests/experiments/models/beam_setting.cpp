#include "tests/experiments/models/beam_setting.hpp"

namespace beamid::test {

experiments::ModelSetting beam_setting(const fem::Beam& beam, int elements,
                                       const std::vector<SensorAt>& sensors,
                                       const std::vector<double>& forces) {
  using Eigen::Index, Eigen::MatrixXd;
  experiments::ModelSetting setting;
  experiments::StructurePoints points(beam);
  std::vector<double> nodes;
  for (const SensorAt& sensor : sensors) {
    if (sensor.quantity == Quantity::strain)
      nodes.push_back(sensor.position);
    else
      points.add(sensor.position);
  }
  for (const double position : forces) setting.forces.push_back(points.add(position));
  const fem::Beam with_nodes = fem::with_nodes(beam, nodes);
  setting.system = fem::assemble(with_nodes, elements, points.all());
  MatrixXd rows(static_cast<Index>(sensors.size()), setting.system.size());
  setting.system.output_names.clear();
  const MatrixXd deflections = MatrixXd(setting.system.outputs);
  for (Index i = 0; i < rows.rows(); ++i) {
    const SensorAt& sensor = sensors[static_cast<std::size_t>(i)];
    if (sensor.quantity == Quantity::strain)
      rows.row(i) = -surface * MatrixXd(fem::curvature_row(setting.system, sensor.position));
    else
      rows.row(i) = deflections.row(points.add(sensor.position));
    setting.system.output_names.push_back("sensor_" + std::to_string(i + 1));
    setting.observations.push_back({sensor.quantity, setting.system.output_names.back()});
  }
  setting.system.outputs = rows.sparseView();
  setting.continuum = experiments::ModelSetting::Continuum{with_nodes, elements, points.all()};
  return setting;
}

experiments::ParameterChoice parameter(const std::string& quantity) {
  experiments::ParameterChoice choice;
  choice.quantity = quantity;
  return choice;
}

experiments::ParameterChoice in_region(double from, double to) {
  experiments::ParameterChoice choice = parameter("bending_stiffness");
  choice.region = std::pair{from, to};
  return choice;
}

experiments::ParameterChoice of_mode(const std::string& quantity, int mode) {
  experiments::ParameterChoice choice = parameter(quantity);
  choice.mode = mode;
  return choice;
}

void reduce_by(experiments::ModelSetting& setting, const std::string& name, const filters::Options& options) {
  setting.reduction = reduction::reduction_registry().make(name, options);
}

}  // namespace beamid::test
