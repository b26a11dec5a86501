#include "experiments/identify/bounds/identifiability.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/config/read_reduction.hpp"
#include "experiments/identify/bounds/described_motion.hpp"
#include "experiments/identify/bounds/sweeps.hpp"
#include "fem/assembly.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double usual_test_ratio = 0.005;  // of every mode, where neither damping nor a dashpot is described
constexpr Index fewest_test_samples = 16;   // of a record
constexpr double usual_noise = 0.01;        // of the root mean square of what a sensor shows

bool has_dashpots(const Experiment& experiment) {
  return fem::assemble(experiment.structure, experiment.elements).damping.nonZeros() > 0;
}

/// The experiment with all that it leaves open.
Experiment completed(const Experiment& experiment, std::vector<std::string>& notes) {
  Experiment complete = experiment;
  if (std::holds_alternative<fem::Undamped>(complete.damping) && !has_dashpots(experiment)) {
    complete.damping = fem::ModalDamping{{usual_test_ratio}};
    notes.push_back(
        fmt::format("No [damping] is described: every mode has the ratio {:g} %.", 100.0 * usual_test_ratio));
  }
  if (complete.sensors.empty()) {
    complete.sensors = {Sensor{}};
    notes.emplace_back("No [[sensors]] are described: one accelerometer where the beam moves most easily.");
  }
  return complete;
}

/// The channels that show any motion, with their noises.
std::vector<NoisyChannel> noisy_channels(const Experiment& experiment, const DescribedMotion& described,
                                         Identifiability& result) {
  std::vector<NoisyChannel> channels;
  std::string assumed;
  for (std::size_t i = 0; i < described.sensors.size(); ++i) {
    Sensor sensor = described.sensors[i];
    sensor.noise = experiment.sensors[i].noise;
    const auto general = experiment.noise.find(sensor.quantity);
    if (sensor.noise == 0.0 && general != experiment.noise.end()) sensor.noise = general->second;
    const double shown = described.root_mean_squares[static_cast<Index>(i)];
    const bool silent = shown == 0.0, assume = sensor.noise == 0.0 && !silent;
    if (assume) {
      sensor.noise = usual_noise * shown;
      assumed += (assumed.empty() ? "" : ", ") + sensor.name;
    }
    if (silent)
      result.notes.push_back(sensor.name + " shows no motion at all and is left out.");
    else
      channels.push_back({static_cast<Index>(i), sensor.noise});
    result.sensors.push_back({sensor, assume});
  }
  if (channels.empty()) throw std::invalid_argument("no sensor shows any motion; expected one that does");
  if (!assumed.empty())
    result.notes.push_back(fmt::format("Assumed noise, {:g} % of the root mean square of the reading: {}.",
                                       100.0 * usual_noise, assumed));
  return channels;
}

/// What is known of the test before any information is.
void describe_test(const Experiment& complete, const DescribedMotion& test, Index samples,
                   Identifiability& result) {
  const JointModel& model = test.motion.model;
  const double rate = complete.simulation.sampling_rate;
  result.model = complete.model.name;
  result.reduction = to_text(complete.reduction);
  result.coordinates = model.motion_size();
  for (const double omega : model.mode_frequencies)
    if (omega > 0.0) result.frequencies_hz.push_back(omega / (2.0 * std::numbers::pi));
  if (result.frequencies_hz.empty())
    throw std::invalid_argument("the model has no mode that vibrates; expected at least one");
  const double first = 2.0 * std::numbers::pi * result.frequencies_hz.front();
  const double ratio = fem::damping_ratios(complete.damping, VectorXd::Constant(1, first))[0];
  result.slowest_decay = ratio > 0.0 ? 1.0 / (ratio * first) : 0.0;
  result.force_measured = test.motion.inputs.size() > 0;
  result.inputs = test.inputs;
  result.begin = test.begin;
  result.sampling_rate = rate;
  const Index left = samples - static_cast<Index>(std::llround(test.begin * rate));
  if (left < fewest_test_samples)
    throw InputError(complete.excitation.place,
                     "the force acts until the record ends; a record without it has nothing to show");
  result.duration = static_cast<double>(left - 1) / rate;
  const auto shown = std::count_if(result.frequencies_hz.begin(), result.frequencies_hz.end(),
                                   [&](double frequency) { return frequency < 0.5 * rate; });
  if (shown < static_cast<std::ptrdiff_t>(result.frequencies_hz.size()))
    result.notes.push_back(fmt::format(
        "Only {} of {} modes lie below {:g} Hz, half the sampling rate; the record shows the others at other "
        "frequencies.",
        shown, result.frequencies_hz.size(), 0.5 * rate));
}

}  // namespace

MatrixXd silent_combinations(const filters::InformationReport& report) {
  constexpr double rounding = 1e-6;
  MatrixXd rows = report.undetermined().transpose();
  for (Index k = 0; k < rows.rows(); ++k) {  // Gauss-Jordan with complete pivoting
    Index row = 0, column = 0;
    rows.bottomRows(rows.rows() - k).cwiseAbs().maxCoeff(&row, &column);
    rows.row(k).swap(rows.row(k + row));
    rows.row(k) /= rows(k, column);
    for (Index i = 0; i < rows.rows(); ++i)
      if (i != k) rows.row(i) -= rows(i, column) * rows.row(k);
  }
  for (auto row : rows.rowwise()) {
    Index largest = 0;
    row.cwiseAbs().maxCoeff(&largest);
    row /= double(row[largest]);
  }
  return (rows.array().abs() < rounding).select(0.0, rows).transpose();
}

Identifiability find_identifiability(const Experiment& experiment, const std::filesystem::path& folder,
                                     const Progress& progress) {
  const IdentifiabilitySettings& settings = experiment.identifiability;
  Identifiability result;
  const Experiment complete = completed(experiment, result.notes);
  const double rate = complete.simulation.sampling_rate;
  constexpr double most_samples = 1e6;
  if (!(complete.simulation.duration * rate < most_samples))
    throw std::invalid_argument(
        fmt::format("a record of {:g} s at {:g} Hz has {:.3g} samples; expected at most {:g}: set "
                    "simulation.duration_s or "
                    "simulation.sampling_rate_hz, or check that the beam is described in SI units",
                    complete.simulation.duration, rate, complete.simulation.duration * rate, most_samples));
  const auto samples = static_cast<Index>(std::llround(complete.simulation.duration * rate)) + 1;

  progress("the test as described");
  TestView view{complete.sensors, longest_record * (samples - 1) + 1, complete.simulation.duration,
                settings.force_measured};
  const DescribedMotion test = described_motion(complete, folder, view, progress);
  describe_test(complete, test, samples, result);
  const std::vector<NoisyChannel> channels = noisy_channels(complete, test, result);
  progress("record lengths and sampling rates");
  sweep_in_time(test.motion, channels, result);
  progress("places of sensors");
  if (complete.model.name == "sdof")
    result.notes.emplace_back("The model knows one point only: places of sensors make no difference to it.");
  else
    sweep_in_place(complete, folder, channels, result, progress);
  return result;
}

}  // namespace beamid::experiments
