#include "experiments/rig/simulated_test.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Core>

#include "experiments/config/experiment.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/rig/virtual_rig.hpp"
#include "experiments/signal/interpolation.hpp"
#include "experiments/signal/toolbox.hpp"
#include "fem/modes.hpp"
#include "fem/parametric_system.hpp"
#include "fem/response/response.hpp"
#include "fem/structural_system.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::experiments {
namespace {

// The motion of a chain whose storeys follow laws.

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// The chain as described, every input of it measured.
JointModel described_chain(const Experiment& experiment, const fem::StructuralSystem& system,
                           const std::vector<fem::Point>& points) {
  ModelSetting setting;
  setting.system = system;
  setting.observations.assign(static_cast<std::size_t>(system.outputs.rows()), {Quantity::displacement});
  setting.forces.resize(static_cast<std::size_t>(system.inputs.cols()));
  std::iota(setting.forces.begin(), setting.forces.end(), Index{0});
  setting.parameters = {{"storey_stiffness"}};  // some unknown there must be: it stays as described
  setting.damping = experiment.damping;
  setting.storey_springs = experiment.storey_springs;
  setting.continuum = ModelSetting::Continuum{experiment.structure, experiment.elements, points};
  return std::move(*model_registry().make("beam", {{"sensor_bias", false}}, setting));
}

/// As fem::respond(), of the model that an identification uses, by CVODES to 1e-12 a step: inputs run
/// straight between the grid's instants, slips begin at zero.
/// @param system of the chain at these points, whose outputs read displacements
/// @throws std::invalid_argument where the file states a method, or damping that no motion in time has
fem::Response storey_response(const Experiment& experiment, const fem::StructuralSystem& system,
                              const std::vector<fem::Point>& points, const fem::Loading& loading,
                              const fem::TimeGrid& grid) {
  if (experiment.simulation.method.name != "modal")
    throw std::invalid_argument(
        "method '" + experiment.simulation.method.name +
        "' moves linear storeys; expected no [simulation] method beside [[chain.storeys]], "
        "which CVODES moves");
  const JointModel model = described_chain(experiment, system, points);
  const Index n = system.size(), p = system.outputs.rows();
  const auto step = filters::discretise(model.motion, grid.interval, "cvode", {{}, MatrixXd::Identity(p, p)});
  VectorXd state = VectorXd::Zero(static_cast<Index>(model.motion->state_labels().size())), next, rate;
  if (loading.initial_displacement.size() > 0) state.head(n) = loading.initial_displacement;
  if (loading.initial_velocity.size() > 0) state.segment(n, n) = loading.initial_velocity;
  state[model.unknown_places[0]] = model.unknowns[0].guess;

  fem::Response response;
  response.time =
      grid.interval * VectorXd::LinSpaced(grid.samples, 0.0, static_cast<double>(grid.samples - 1));
  for (MatrixXd* rows : {&response.displacement, &response.velocity, &response.acceleration})
    rows->resize(p, grid.samples);
  response.frames = grid.frames;
  const auto frames = static_cast<Index>(grid.frames.size());
  for (MatrixXd* field :
       {&response.field_displacement, &response.field_velocity, &response.field_acceleration})
    field->resize(n, frames);
  const Index inputs = system.inputs.cols();
  const auto input_at = [&](Index k) -> VectorXd {
    return loading.inputs.size() > 0 ? VectorXd(loading.inputs.col(k)) : VectorXd::Zero(inputs);
  };
  for (Index k = 0, frame = 0; k < grid.samples; ++k) {
    const VectorXd input = input_at(k);
    model.motion->rate(state, input, rate);
    const VectorXd q = state.head(n), v = state.segment(n, n), a = rate.segment(n, n);
    response.displacement.col(k) = system.outputs * q;
    response.velocity.col(k) = system.outputs * v;
    response.acceleration.col(k) = system.outputs * a;
    if (frame < frames && grid.frames[static_cast<std::size_t>(frame)] == k) {
      response.field_displacement.col(frame) = q;
      response.field_velocity.col(frame) = v;
      response.field_acceleration.col(frame++) = a;
    }
    if (k + 1 == grid.samples) break;
    VectorXd path(2 * inputs);
    path << input, input_at(k + 1) - input;
    try {
      step->transition(state, path, next);
    } catch (const std::runtime_error& error) {
      throw InputError(
          experiment.storey_springs.front().law.place,
          fmt::format("the motion of storeys that follow laws cannot be followed beyond {:.4g} s ({}): "
                      "a spring that softens lets go where the motion is large. Expected a smaller "
                      "excitation, or a law that pushes back",
                      response.time[k], error.what()));
    }
    state.swap(next);
  }
  return response;
}

// When the logger of a virtual test samples, and what it reads then.

/// When the logger samples: `count` samples during the motion, and those before it.
struct SampleClock {
  Eigen::VectorXd time;     ///< (N) [s], from 0
  double event = 0.0;       ///< the motion's t = 0 on this clock [s]
  Eigen::Index before = 0;  ///< samples before it
  bool even = true;
};

SampleClock clock_of(const Acquisition& acquisition, const Simulation& settings, Eigen::Index count);

/// True readings (N) at the clock's instants from those at the steps of the integration. Before the motion
/// the beam is held where it starts: only displacements and strains show that.
Eigen::VectorXd readings_at(const SampleClock& clock, const Eigen::VectorXd& step_time,
                            const Eigen::VectorXd& values, Eigen::Index steps, Quantity quantity);

SampleClock clock_of(const Acquisition& acquisition, const Simulation& settings, Index count) {
  SampleClock clock;
  clock.before = static_cast<Index>(std::llround(acquisition.pretrigger * settings.sampling_rate));
  clock.event = static_cast<double>(clock.before) / settings.sampling_rate;
  clock.time = sample_instants(acquisition, clock.before + count, settings.sampling_rate, settings.seed);
  clock.even = !(acquisition.jitter > 0);
  return clock;
}

VectorXd readings_at(const SampleClock& clock, const VectorXd& step_time, const VectorXd& values, Index steps,
                     Quantity quantity) {
  const bool held = quantity == Quantity::displacement || quantity == Quantity::strain;
  VectorXd readings = VectorXd::Constant(clock.time.size(), held ? values[0] : 0.0);
  if (clock.even) {
    const Index count = clock.time.size() - clock.before;
    readings.tail(count) = values(Eigen::seqN(Index{0}, count, steps));
    return readings;
  }
  const CubicSpline spline(step_time, values);
  const double last = step_time[step_time.size() - 1];
  for (Index k = 0; k < readings.size(); ++k)
    if (const double t = clock.time[k] - clock.event; t >= 0) readings[k] = spline(std::min(t, last));
  return readings;
}

// The modes of a simulation that its record can show.

// Modes below half the sampling rate: what an instrument's anti-aliasing filter lets through. One above
// appears in the record at another frequency.
struct Audible {
  Index count = 0;       ///< 200 at most
  double next_hz = 0.0;  ///< frequency of the first above; 0: there is none
};

Audible audible_modes(const fem::StructuralSystem& system, double limit_hz) {
  constexpr Index most = 200;
  for (Index few = std::min<Index>(system.size(), 25);;
       few = std::min(2 * few, std::min(system.size(), most))) {
    const VectorXd frequency = fem::modes(system, few).frequency_hz();
    const Index below = (frequency.array() < limit_hz).count();
    if (below < few) return {below, frequency[below]};
    if (few == std::min(system.size(), most)) return {few, 0.0};
  }
}

/// The method as set. The modal one gets as many modes as the record can show, those below half the sampling
/// rate and 200 at most, unless the file says how many; a note says what the others show.
fem::ResponseMethod audible_method(const Simulation& settings, const fem::StructuralSystem& system,
                                   std::vector<std::string>& notes) {
  fem::ResponseMethod method = settings.method;
  const double limit = 0.5 * settings.sampling_rate;
  const Audible audible = audible_modes(system, limit);
  if (audible.count == 0 && audible.next_hz > 0.0)
    notes.push_back(fmt::format(
        "ALIASED: no mode lies below half the sampling rate, {:g} Hz. The first, at {:.5g} Hz, appears in "
        "the record at {:.5g} Hz.",
        limit, audible.next_hz, std::abs(std::remainder(audible.next_hz, settings.sampling_rate))));
  if (method.name == "modal" && !method.options.contains("modes") && audible.count > 0) {
    method.options["modes"] = static_cast<double>(audible.count);
    notes.push_back(fmt::format("{} of {} modes {} used: {}. simulation.modes sets another number.",
                                audible.count, system.size(), audible.count == 1 ? "is" : "are",
                                audible.next_hz > 0.0
                                    ? fmt::format("{} below {:g} Hz, half the sampling rate",
                                                  audible.count == 1 ? "the one" : "those", limit)
                                    : "the lowest"));
  } else if (method.name == "modal" && !method.options.contains("modes")) {
    method.options["modes"] = 1.0;
  } else if (audible.count > 0 && audible.next_hz > 0.0 &&
             (method.name != "modal" || method.options["modes"] == 0.0 ||
              method.options["modes"] > static_cast<double>(audible.count))) {
    notes.push_back(fmt::format(
        "Half the sampling rate is {:g} Hz, the frequency of mode {} is {:.5g} Hz: this mode and those "
        "above it appear in the record at other frequencies.",
        limit, audible.count + 1, audible.next_hz));
  }
  return method;
}

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

/// Instants of a whole motion. Eight samples are a fraction of a period of what can be seen: a record has ten
/// or more for each period of its lowest mode.
std::vector<Index> motion_samples(Index samples, Index coordinates, Index steps) {
  constexpr Index most_samples = 4000, most_numbers = 4'000'000, longest_stride = 8;
  const Index most = std::clamp<Index>(most_numbers / coordinates, 2, most_samples);
  const Index stride = std::clamp<Index>((samples + most - 1) / most, 1, longest_stride);
  std::vector<Index> kept;
  for (Index k = 0; k < samples && static_cast<Index>(kept.size()) < most; k += stride)
    kept.push_back(k * steps);
  return kept;
}

/// Takes the whole motion out of a response, which keeps the fields at its frames.
void separate(const std::vector<Index>& frames, const std::vector<Index>& shown, fem::Response& response,
              WholeMotion& motion) {
  const auto places_of = [all = response.frames](const std::vector<Index>& some) {
    std::vector<Index> places;
    for (const Index one : some)
      places.push_back(std::lower_bound(all.begin(), all.end(), one) - all.begin());
    return places;
  };
  motion = {response.time(shown), response.field_displacement(Eigen::all, places_of(shown))};
  for (MatrixXd* field :
       {&response.field_displacement, &response.field_velocity, &response.field_acceleration})
    *field = MatrixXd((*field)(Eigen::all, places_of(frames)));
  response.frames = frames;
}

}  // namespace

SimulatedTest simulate(const Experiment& experiment, const std::filesystem::path& folder, int frames,
                       const Progress& progress, const Acquisition& acquisition, WholeMotion* motion) {
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
  std::vector<Index> pictures, shown;
  for (const Index sample : evenly_spread(affordable_frames(frames, test.system.size(), test.notes), samples))
    pictures.push_back(sample * steps);
  if (motion && !test.system.mesh.nodes.empty()) shown = motion_samples(samples, test.system.size(), steps);
  std::set_union(pictures.begin(), pictures.end(), shown.begin(), shown.end(),
                 std::back_inserter(grid.frames));
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
  if (!shown.empty()) separate(pictures, shown, test.response, *motion);
  for (const std::string& remark : test.response.remarks) test.notes.push_back(remark);

  const SampleClock clock = clock_of(acquisition, settings, samples);
  test.event = clock.event;
  if (!shown.empty()) motion->time.array() += clock.event;
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
    test.record.objections.emplace_back(
        "unrecorded_base",
        "The base moves, which the record does not hold: an identification takes this motion for a free "
        "decay.");
  for (std::size_t i = 0; acquisition.force && i < inputs.size(); ++i)
    add_input(test, clock, test.excitations[i], inputs[i], history, steps, settings.seed, structure);
  lose_samples(acquisition, test.record, settings.seed);
  return test;
}

}  // namespace beamid::experiments
