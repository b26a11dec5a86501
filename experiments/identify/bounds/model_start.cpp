#include "experiments/identify/bounds/model_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/identify/nonlinear_reproduction.hpp"
#include "experiments/identify/record_inputs.hpp"
#include "experiments/identify/reproduction.hpp"
#include "experiments/models/finest_discretisation.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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

}  // namespace

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
    throw std::invalid_argument(
        fmt::format("{:g} periods of the first mode, of {:.3g} s each, are {:.3g} samples at {:g} Hz; "
                    "expected at most {:g}: lower "
                    "simulation.sampling_rate_hz, or check that the beam is described in SI units",
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

}  // namespace beamid::experiments
