#include "tests/experiments/identify/update/update_cases.hpp"

#include <fmt/format.h>

#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/update/modal_model.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {

Experiment experiment_of(const std::string& toml) {
  return read_experiment(TomlTable::parse(toml, "test.toml"));
}

Experiment four_storeys() {
  constexpr double mass = 12.060 / 386.088 * lbf_per_in;  // lbf s2/in in kg
  std::string sensors;
  for (int floor = 1; floor <= 4; ++floor) sensors += fmt::format("[[sensors]]\nposition_m = {}\n", floor);
  return experiment_of(
      fmt::format("[chain]\nmasses_kg = [{0}, {0}, {0}, {0}]\n"
                  "stiffnesses_n_per_m = [{1}, {1}, {1}, {1}]\n{2}",
                  mass, 10 * lbf_per_in, sensors));
}

Experiment three_storeys() {
  return experiment_of(
      "[chain]\nmasses_kg = [5.36, 5.36, 5.36]\nstiffnesses_n_per_m = [60000, 60000, 60000]\n"
      "[[sensors]]\nposition_m = 1\n[[sensors]]\nposition_m = 2\n[[sensors]]\nposition_m = 3\n");
}

ModalData frequencies(const std::vector<double>& frequencies_hz) {
  ModalData data{"test", {}};
  for (const double f : frequencies_hz) data.modes.push_back({f});
  return data;
}

ModalData predicted_data(const Experiment& experiment, const Eigen::VectorXd& values, Eigen::Index count) {
  std::vector<fem::Point> points;
  for (const Sensor& sensor : experiment.sensors)
    points.push_back({fmt::format("s{}", points.size()), sensor.position.value()});
  const ModalModel model(experiment.structure, experiment.elements, points, asked_parameters(experiment),
                         count);
  const PredictedModes modes = model.at(values, false);
  ModalData data{"test", {}};
  for (Eigen::Index i = 0; i < count; ++i) {
    MeasuredMode mode{modes.frequency_hz[i]};
    mode.shape = modes.shapes.col(i) / modes.shapes.col(i).cwiseAbs().maxCoeff();
    data.modes.push_back(mode);
  }
  return data;
}

ModalData with_errors(ModalData data, double frequency_share, std::uint64_t seed, std::uint64_t stream) {
  constexpr double of_shapes = 0.02;
  filters::RandomStream random(seed, stream);
  for (MeasuredMode& mode : data.modes) {
    mode.deviation_hz = frequency_share * mode.frequency_hz;
    mode.frequency_hz += mode.deviation_hz * random.normal(1, 1)(0, 0);
    mode.shape += of_shapes * random.normal(mode.shape.size(), 1);
    mode.shape_deviation = of_shapes;
  }
  return data;
}

}  // namespace beamid::experiments
