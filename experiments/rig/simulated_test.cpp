#include "experiments/rig/simulated_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/rig/audible_modes.hpp"
#include "experiments/rig/excitation_history.hpp"
#include "experiments/rig/sample_clock.hpp"
#include "experiments/rig/storey_response.hpp"
#include "experiments/signal/random.hpp"
#include "fem/gauge_row.hpp"
#include "fem/parametric_system.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

std::vector<Sensor> default_sensors() {
  return {{"", {}, Quantity::displacement, 0.0}, {"", {}, Quantity::acceleration, 0.0}};
}

std::vector<Index> evenly_spread(int count, Index samples) {
  std::vector<Index> frames;
  const Index kept = std::min<Index>(count, samples);
  for (Index i = 0; i < kept; ++i) frames.push_back(kept == 1 ? 0 : i * (samples - 1) / (kept - 1));
  return frames;
}

// The base's acceleration, as far as it goes the sensor's way, is part of what an accelerometer shows.
VectorXd clean_history(const SimulatedTest& test, Quantity quantity, Index output, const VectorXd& base) {
  const fem::Response& r = test.response;
  if (quantity == Quantity::displacement || quantity == Quantity::strain) return r.displacement.row(output);
  if (quantity == Quantity::velocity) return r.velocity.row(output);
  VectorXd acceleration = r.acceleration.row(output);
  if (base.size() > 0)
    acceleration += (test.system.base_shares.size() > 0 ? test.system.base_shares[output] : 1.0) * base;
  return acceleration;
}

std::string force_name(const Excitation& excitation, const fem::Structure& structure) {
  return structure.has_positions() ? name_of_place(*excitation.position, structure.extent()) : excitation.at;
}

bool is_base(const Excitation& excitation) {
  return excitation.kind == Excitation::Kind::base;
}

void require_inputs_of_their_own(const std::vector<Excitation>& excitations, const std::vector<Index>& inputs,
                                 const fem::StructuralSystem& system) {
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (is_base(excitations[i]) && !system.is_moved_by_base())
      throw InputError(excitations[i].place,
                       "the base moves, which does not move the structure; expected base_motion in [system]");
    for (std::size_t k = 0; k < i; ++k)
      if (is_base(excitations[k]) == is_base(excitations[i]) &&
          (is_base(excitations[i]) || inputs[k] == inputs[i]))
        throw InputError(excitations[i].place,
                         "acts where another one of [[excitations]] does; expected one");
  }
}

// An output row for every strain gauge, -c w'' at its node, behind those of the points.
void add_gauges(const fem::Beam& beam, SimulatedTest& test, std::vector<Index>& outputs) {
  for (std::size_t i = 0; i < test.sensors.size(); ++i) {
    const Sensor& sensor = test.sensors[i];
    if (sensor.quantity != Quantity::strain) continue;
    fem::StructuralSystem& system = test.system;
    outputs[i] = system.outputs.rows();
    const Eigen::MatrixXd gauge =
        -sensor.distance * Eigen::MatrixXd(fem::gauge_row(system, beam, *sensor.position));
    Eigen::MatrixXd rows(system.outputs.rows() + 1, system.size());
    rows << Eigen::MatrixXd(system.outputs), gauge;
    system.outputs = rows.sparseView();
    system.output_names.push_back(sensor.name + "_strain");
  }
}

// A field of so many numbers at all frames together fits into the memory of any machine.
int affordable_frames(int frames, Index coordinates, std::vector<std::string>& notes) {
  constexpr double most_numbers = 2e7;
  const int affordable = static_cast<int>(most_numbers / static_cast<double>(coordinates));
  if (frames <= affordable) return frames;
  notes.push_back(
      fmt::format("{} of the {} pictures of the whole beam are kept: more would not fit into memory.",
                  affordable, frames));
  return affordable;
}

// What the straight line between the samples (every `steps`-th value) misses, as a sentence.
std::string missed_between_samples(const VectorXd& force, Index steps, const char* what) {
  constexpr double visible = 1e-3;  // of its root mean square
  VectorXd missed = VectorXd::Zero(force.size());
  for (Index k = 0; steps > 1 && k + 1 < force.size(); ++k) {
    const Index before = k / steps * steps;
    const double part = static_cast<double>(k - before) / static_cast<double>(steps);
    missed[k] = force[k] - (1.0 - part) * force[before] - part * force[before + steps];
  }
  const double loss = missed.norm();
  if (!(loss > visible * force.norm())) return {};
  return fmt::format(
      "Between the samples the {} moves off the straight line by {:.2g} % of its size: an "
      "identification that takes the record of it for straight is wrong by as much. A higher "
      "sampling_rate_hz helps.",
      what, 100.0 * loss / force.norm());
}

/// A force, or the acceleration of the base, at the samples as one more channel of the record: a measured
/// test has it, too. Without it a forced motion would be taken for a free decay.
void add_input(SimulatedTest& test, const SampleClock& clock, const Excitation& excitation, Index input,
               const ExcitationHistory& history, Index steps, std::uint64_t seed,
               const fem::Structure& structure) {
  if (!has_force_history(excitation)) return;
  const bool base = is_base(excitation);
  const VectorXd force = base ? history.base_acceleration : VectorXd(history.loading.inputs.row(input));
  if (const std::string missed = missed_between_samples(force, steps, base ? "base" : "force");
      !missed.empty())
    test.notes.push_back(missed);
  Channel channel = base ? Channel{Quantity::base_acceleration, "base_acceleration", {}, 0.0}
                         : Channel{Quantity::force, force_name(excitation, structure), excitation.position,
                                   0.0, excitation.at};
  VectorXd readings = readings_at(clock, test.response.time, force, steps, channel.quantity);
  constexpr std::uint64_t input_stream = 2000;
  channel.noise = base ? test.acquisition.base_noise : test.acquisition.force_noise;
  if (channel.noise > 0.0)
    readings += channel.noise *
                standard_normal(readings.size(), seed, input_stream + static_cast<std::uint64_t>(input));
  test.record.samples.conservativeResize(test.record.samples.rows() + 1, Eigen::NoChange);
  test.record.samples.bottomRows(1) = readings.transpose();
  test.record.channels.push_back(channel);
  test.record.input_path = InputPath::linear;
}

}  // namespace

SimulatedTest simulate(const Experiment& experiment, const std::filesystem::path& folder, int frames,
                       const Progress& progress, const Acquisition& acquisition) {
  const Simulation& settings = experiment.simulation;
  SimulatedTest test;
  test.sensors = experiment.sensors.empty() ? default_sensors() : experiment.sensors;
  test.excitations = experiment.further_excitations;
  test.excitations.insert(test.excitations.begin(), experiment.excitation);
  test.acquisition = acquisition;
  const fem::Structure& structure = experiment.structure;
  StructurePoints points(structure);
  std::vector<Index> outputs;
  std::vector<double> gauges;
  for (Sensor& sensor : test.sensors) {
    if (sensor.quantity == Quantity::strain) {
      gauges.push_back(*sensor.position);
      outputs.push_back(-1);
      if (sensor.name.empty()) sensor.name = name_of_place(*sensor.position, structure.extent());
      continue;
    }
    outputs.push_back(points.add(sensor.position, sensor.place, is_angular(sensor.quantity)));
    if (structure.has_positions()) sensor.position = points[outputs.back()].position;
    if (sensor.name.empty()) sensor.name = points[outputs.back()].name;
  }
  std::vector<Index> inputs;
  for (Excitation& excitation : test.excitations) {
    inputs.push_back(points.add(excitation.position, excitation.at));
    if (structure.has_positions()) excitation.position = points[inputs.back()].position;
  }
  progress("assembling");
  test.system =
      fem::assemble(gauges.empty() ? structure : fem::Structure(fem::with_nodes(structure.beam(), gauges)),
                    experiment.elements, points.all());
  if (!gauges.empty()) add_gauges(structure.beam(), test, outputs);
  require_inputs_of_their_own(test.excitations, inputs, test.system);

  constexpr int fewest_between_stamps = 8;
  const int steps = acquisition.jitter > 0 ? std::max(settings.steps_per_sample, fewest_between_stamps)
                                           : settings.steps_per_sample;
  const auto samples = static_cast<Index>(std::llround(settings.duration * settings.sampling_rate)) + 1;
  fem::TimeGrid grid{1.0 / (settings.sampling_rate * steps), (samples - 1) * steps + 1, {}};
  ExcitationHistory history;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const ExcitationHistory one =
        excite(test.excitations[i], test.system, inputs[i], grid, folder, settings.seed);
    if (i == 0)
      history = one;
    else
      add(one, history);
  }
  test.notes = std::move(history.notes);
  for (const Index sample : evenly_spread(affordable_frames(frames, test.system.size(), test.notes), samples))
    grid.frames.push_back(sample * steps);
  test.step = grid.interval;
  if (experiment.storey_springs.empty()) {
    progress("modes");
    test.method = audible_method(settings, test.system, test.notes);
    progress("integrating");
    test.response = fem::respond(test.system, experiment.damping, history.loading, grid, test.method);
  } else {
    progress("integrating");
    test.method.name = "cvode";
    test.response = storey_response(experiment, test.system, points.all(), history.loading, grid);
  }
  for (const std::string& remark : test.response.remarks) test.notes.push_back(remark);

  const SampleClock clock = clock_of(acquisition, settings, samples);
  test.event = clock.event;
  test.record.time = clock.time;
  test.record.samples.resize(static_cast<Index>(test.sensors.size()), clock.time.size());
  for (std::size_t i = 0; i < test.sensors.size(); ++i) {
    const Sensor& sensor = test.sensors[i];
    const VectorXd values = clean_history(test, sensor.quantity, outputs[i], history.base_acceleration),
                   readings = readings_at(clock, test.response.time, values, steps, sensor.quantity);
    VectorXd noise = VectorXd::Zero(readings.size());
    if (sensor.noise > 0.0) noise = sensor.noise * standard_normal(readings.size(), settings.seed, i);
    constexpr std::size_t rattle_stream = 1000;
    test.record.samples.row(static_cast<Index>(i)) =
        shown_readings(acquisition.of(i), clock.time, readings, noise, settings.seed, rattle_stream + i)
            .transpose();
    test.record.channels.push_back(
        {sensor.quantity, sensor.name, sensor.position, sensor.distance, sensor.place});
  }
  const bool of_base = history.base_acceleration.size() > 0;
  if (of_base && !acquisition.force)
    test.record.warnings.emplace_back(
        "The base moves, which the record does not hold: an identification takes this motion for a free "
        "decay.");
  for (std::size_t i = 0; acquisition.force && i < inputs.size(); ++i)
    add_input(test, clock, test.excitations[i], inputs[i], history, steps, settings.seed, structure);
  lose_samples(acquisition, test.record, settings.seed);
  return test;
}

}  // namespace beamid::experiments
