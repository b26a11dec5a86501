#include "experiments/rig/virtual_rig.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>
#include <Eigen/SparseCholesky>
#include <boost/math/special_functions/gamma.hpp>

#include "experiments/record/read_record.hpp"
#include "experiments/signal/toolbox.hpp"
#include "experiments/text/choice.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "fem/stiffness_solver.hpp"

namespace beamid::experiments {

ReleasedBeam release(const Release& settings) {
  const fem::StructuralSystem system = fem::assemble(settings.beam, settings.elements);
  ReleasedBeam result;
  result.modes = fem::modes(system, settings.modes);
  result.modal_amplitudes =
      fem::modal_amplitudes(system, result.modes, settings.tip_deflection * fem::static_shape(system));
  Eigen::VectorXd damping = Eigen::VectorXd::Constant(settings.modes, settings.higher_damping_ratio);
  damping[0] = settings.first_damping_ratio;
  const auto samples = static_cast<Eigen::Index>(std::lround(settings.duration * settings.sampling_rate)) + 1;
  result.time =
      Eigen::VectorXd::LinSpaced(samples, 0, static_cast<double>(samples - 1)) / settings.sampling_rate;
  result.tip = fem::free_decay(result.modal_amplitudes, result.modes.angular_frequency, damping, result.time);
  return result;
}

Record measure_acceleration(const ReleasedBeam& beam, double noise, std::uint64_t seed,
                            std::uint64_t stream) {
  Record record;
  record.time = beam.time;
  record.samples =
      (beam.tip.acceleration + noise * standard_normal(beam.time.size(), seed, stream)).transpose();
  record.channels = {{Quantity::acceleration, "tip"}};
  return record;
}

namespace {

using Eigen::Index, Eigen::VectorXd;

// Of a seed, far from the streams of the sensors' noise, which count from 0.
constexpr std::uint64_t stamps_stream = 1u << 20, repeats_stream = stamps_stream + 1,
                        gaps_stream = stamps_stream + 2;

/// (mean - median) / standard deviation of a gamma distribution of this shape.
double relative_shortfall(double shape) {
  return (shape - boost::math::gamma_p_inv(shape, 0.5)) / std::sqrt(shape);
}

/// The shape with a given relative shortfall, which falls from 0.41 at 0.25 to 1/3 shape^(-1/2).
double shape_of(double shortfall) {
  double least = 0.25, most = 1e4;
  for (int i = 0; i < 60; ++i) {
    const double middle = std::sqrt(least * most);
    (relative_shortfall(middle) > shortfall ? least : most) = middle;
  }
  return std::sqrt(least * most);
}

/// Mean one, standard deviation and shortfall as asked for (n).
VectorXd relative_intervals(const Acquisition& acquisition, Index n, std::uint64_t seed) {
  constexpr double shortest = 0.05, hardly = 1e-3;
  const double shortfall = acquisition.median_shortfall / acquisition.jitter;
  if (shortfall > largest_shortfall)
    throw std::invalid_argument(
        fmt::format("median_shortfall is {:g} at a jitter of {:g}; expected {:g} of it at most",
                    acquisition.median_shortfall, acquisition.jitter, largest_shortfall));
  filters::RandomStream random(seed, stamps_stream);
  VectorXd interval(n);
  if (shortfall < hardly) {
    interval = 1 + acquisition.jitter * random.normal(n, 1).col(0).array();
  } else {
    const double shape = shape_of(shortfall), scale = acquisition.jitter / std::sqrt(shape);
    for (Index k = 0; k < n; ++k)
      interval[k] = 1 + scale * (boost::math::gamma_p_inv(shape, random.uniform()) - shape);
  }
  interval = interval.cwiseMax(shortest);
  return interval / interval.mean();
}

double largest_size(const VectorXd& readings) {
  return readings.size() > 0 ? readings.cwiseAbs().maxCoeff() : 0.0;
}

}  // namespace

VectorXd sample_instants(const Acquisition& acquisition, Index count, double rate, std::uint64_t seed) {
  VectorXd time = VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1)) / rate;
  if (!(acquisition.jitter > 0) || count < 2) return time;
  const VectorXd interval = relative_intervals(acquisition, count - 1, seed) / rate;
  for (Index k = 1; k < count; ++k) time[k] = time[k - 1] + interval[k - 1];
  return time;
}

VectorXd shown_readings(const SensorDefects& sensor, const VectorXd& time, const VectorXd& readings,
                        const VectorXd& noise, std::uint64_t seed, std::uint64_t stream) {
  const Index count = time.size();
  const double largest = largest_size(readings), length = count > 1 ? time[count - 1] - time[0] : 1.0;
  if (sensor.dead) return VectorXd::Constant(count, sensor.offset * largest);
  VectorXd shown = readings + noise;
  if (sensor.rattle > 0) {
    const VectorXd rattle = sensor.rattle * largest * standard_normal(count, seed, stream);
    shown += (readings.cwiseAbs().array() > sensor.rattle_above * largest).select(rattle, 0.0);
  }
  const Eigen::ArrayXd since = time.array() - time[0];
  shown.array() += largest * (sensor.offset + sensor.drift * since / length +
                              sensor.startup * (-since / sensor.startup_time).exp());
  if (sensor.clipping > 0)
    shown = shown.cwiseMax(-sensor.clipping * largest).cwiseMin(sensor.clipping * largest);
  if (const double step = sensor.resolution * largest; step > 0)
    shown = (shown / step).array().round() * step;
  return shown;
}

void lose_samples(const Acquisition& acquisition, Record& record, std::uint64_t seed) {
  const Index count = record.size();
  if (acquisition.repeated > 0) {
    filters::RandomStream random(seed, repeats_stream);
    for (Index k = 1; k < count; ++k)
      if (random.uniform() < acquisition.repeated) record.samples.col(k) = record.samples.col(k - 1);
  }
  if (acquisition.gaps == 0) return;
  filters::RandomStream random(seed, gaps_stream);
  const double part = (record.time[count - 1] - record.time[0]) / acquisition.gaps;
  const auto [least, most] = acquisition.gap;
  std::vector<bool> kept(static_cast<std::size_t>(count), true);
  for (int g = 0; g < acquisition.gaps; ++g) {
    const double length = least * std::pow(most / least, random.uniform()),
                 from = record.time[0] + part * (g + random.uniform() * std::max(0.0, 1 - length / part));
    const double* const begin = record.time.data();
    const Index last = std::min<Index>(std::lower_bound(begin, begin + count, from) - begin, count - 1);
    for (Index k = last + 1; k < count && record.time[k] < record.time[last] + length; ++k)
      kept[static_cast<std::size_t>(k)] = false;
  }
  Index left = 0;
  for (Index k = 0; k < count; ++k) {
    if (!kept[static_cast<std::size_t>(k)]) continue;
    record.time[left] = record.time[k];
    record.samples.col(left++) = record.samples.col(k);
  }
  record.time.conservativeResize(left);
  record.samples.conservativeResize(Eigen::NoChange, left);
}

namespace {

using Kind = Excitation::Kind;
using std::numbers::pi;

struct Case {
  const Excitation& excitation;
  const fem::StructuralSystem& system;
  Index input;
  const fem::TimeGrid& grid;
  const std::filesystem::path& folder;
  std::uint64_t seed;

  double time(Index k) const { return static_cast<double>(k) * grid.interval; }
};

// The shape scaled to 1 at the point: of a static force there, or of a mode.
VectorXd shape(const Case& c) {
  if (!c.excitation.mode) {
    try {
      return fem::static_shape(c.system, c.input, c.input);
    } catch (const std::runtime_error& error) {  // nothing holds the beam
      const std::string reason =
          std::string("no static shape to be released from: ") + error.what() +
          "; expected a beam that is held, or another kind of excitation, as 'impulse' or 'free' with a mode";
      if (c.excitation.place.file.empty()) throw std::invalid_argument(reason);
      throw InputError(c.excitation.place, reason);
    }
  }
  const Index mode = *c.excitation.mode;
  if (mode > c.system.size())
    throw InputError(c.excitation.place,
                     fmt::format("excitation.mode is {}; expected 1 to {}", mode, c.system.size()));
  const VectorXd found = fem::modes(c.system, mode).shape.col(mode - 1);
  const double there = (c.system.outputs.row(c.input) * found)(0);
  if (std::abs(there) < 1e-9 * (c.system.outputs * found).cwiseAbs().maxCoeff() || there == 0.0)
    throw InputError(
        c.excitation.place,
        fmt::format("mode {} does not move the excitation's point; expected another position_m", mode));
  return found / there;
}

VectorXd sine(const Case& c, std::vector<std::string>& notes) {
  const double turn = 2.0 * pi * c.excitation.frequency_hz;
  // A sine drawn through samples is too small by (omega dt)^2 / 12.
  if (const double loss = std::pow(turn * c.grid.interval, 2) / 12.0; loss > 1e-3)
    notes.push_back(fmt::format(
        "The excitation of {:g} Hz has {:.1f} steps a period: drawn straight from step to step it is {:.1f} "
        "% too small. More steps_per_sample, or a higher sampling_rate_hz, help.",
        c.excitation.frequency_hz, 1.0 / (c.excitation.frequency_hz * c.grid.interval), 100.0 * loss));
  return VectorXd::NullaryExpr(c.grid.samples,
                               [&](Index k) { return c.excitation.amplitude * std::sin(turn * c.time(k)); });
}

// Normal numbers, 2 f of them a second, straight between them: each excitation has a stream of its own.
VectorXd random_force(const Case& c) {
  const double rate = 2.0 * c.excitation.frequency_hz, end = c.time(c.grid.samples - 1);
  const auto count = static_cast<Index>(std::ceil(rate * end)) + 2;
  constexpr std::uint64_t first_stream = 5000;
  const VectorXd drawn = c.excitation.amplitude *
                         standard_normal(count, c.seed, first_stream + static_cast<std::uint64_t>(c.input));
  return VectorXd::NullaryExpr(c.grid.samples, [&](Index k) {
    const double at = rate * c.time(k);
    const Index before = std::min(static_cast<Index>(at + 1e-9), count - 2);
    const double part = std::max(at - static_cast<double>(before), 0.0);
    return (1.0 - part) * drawn[before] + part * drawn[before + 1];
  });
}

void check_duration(const Case& c) {
  const double steps = c.excitation.duration / c.grid.interval;
  if (steps < 4.0)
    throw InputError(
        c.excitation.place,
        fmt::format("excitation.duration_s is {:g}, {:.3g} steps of {:g} s; expected at least 4 (raise "
                    "simulation.steps_per_sample or sampling_rate_hz), or 0 for an instant",
                    c.excitation.duration, steps, c.grid.interval));
}

// A half sine whose samples, joined by straight lines, carry the momentum exactly.
VectorXd half_sine(const Case& c) {
  check_duration(c);
  VectorXd force = VectorXd::NullaryExpr(c.grid.samples, [&](Index k) {
    return c.time(k) < c.excitation.duration ? std::sin(pi * c.time(k) / c.excitation.duration) : 0.0;
  });
  return c.excitation.momentum / (force.sum() * c.grid.interval) * force;
}

// A hand that lets go: from the force that holds the deflection down to nothing, along half a cosine.
VectorXd let_go(const Case& c, double deflection) {
  check_duration(c);
  const double duration = c.excitation.duration,
               force = deflection * fem::static_stiffness(c.system, c.input, c.input);
  return VectorXd::NullaryExpr(c.grid.samples, [&](Index k) {
    return c.time(k) < duration ? 0.5 * force * (1.0 + std::cos(pi * c.time(k) / duration)) : 0.0;
  });
}

// The force, or the acceleration of the base, as itself or as a sensor on it reads it.
Quantity exciting_quantity(const Case& c, const Record& record) {
  if (c.excitation.kind != Kind::base) return Quantity::force;
  const bool own = std::any_of(record.channels.begin(), record.channels.end(), [](const Channel& channel) {
    return channel.quantity == Quantity::base_acceleration;
  });
  return own ? Quantity::base_acceleration : Quantity::acceleration;
}

// Linear between the file's rows, nothing before and after them.
VectorXd from_file(const Case& c, std::vector<std::string>& notes) {
  const std::filesystem::path file = c.folder / *c.excitation.file;
  const Record record = read_record(file);
  const VectorXd values =
      at_place({file.string()}, [&] { return record.channel(exciting_quantity(c, record)); });
  const double begin = record.time[0], end = record.time[record.size() - 1];
  if (begin > 0.0 || end < c.time(c.grid.samples - 1))
    notes.push_back(fmt::format("{} runs from {:g} to {:g} s; outside it the excitation is zero.",
                                file.filename().string(), begin, end));
  Index row = 0;
  return VectorXd::NullaryExpr(c.grid.samples, [&](Index k) {
    const double t = c.time(k);
    if (t < begin || t > end) return 0.0;
    while (row + 2 < record.size() && record.time[row + 1] <= t) ++row;
    const double part = (t - record.time[row]) / (record.time[row + 1] - record.time[row]);
    return values[row] + part * (values[row + 1] - values[row]);
  });
}

VectorXd struck(const Case& c) {
  const fem::SparseMatrix mass = c.system.mass;
  const Eigen::SimplicialLDLT<fem::SparseMatrix> solver(mass);
  if (solver.info() != Eigen::Success)
    throw InputError(c.excitation.place, "the mass matrix is singular; expected duration_s of the pulse");
  return solver.solve(VectorXd(c.excitation.momentum * c.system.inputs.col(c.input)));
}

void set_input(const Case& c, Index input, const VectorXd& history, ExcitationHistory& result) {
  result.loading.inputs = Eigen::MatrixXd::Zero(c.system.inputs.cols(), c.grid.samples);
  result.loading.inputs.row(input) = history.transpose();
}

}  // namespace

bool has_force_history(const Excitation& excitation) {
  switch (excitation.kind) {
    case Kind::step:
    case Kind::harmonic:
    case Kind::random:
    case Kind::table:
    case Kind::base:
      return true;
    case Kind::impulse:
      return excitation.duration > 0.0;
    case Kind::release:
    case Kind::free:
      break;
  }
  return false;
}

ExcitationHistory excite(const Excitation& excitation, const fem::StructuralSystem& system, Index input,
                         const fem::TimeGrid& grid, const std::filesystem::path& folder, std::uint64_t seed) {
  constexpr double study_deflection = 0.012;  // of the study's tests [m]
  const Case c{excitation, system, input, grid, folder, seed};
  ExcitationHistory result;
  switch (excitation.kind) {
    case Kind::release: {
      const double deflection = excitation.deflection.value_or(study_deflection);
      result.loading.initial_displacement = deflection * shape(c);
      if (excitation.duration > 0.0) set_input(c, input, let_go(c, deflection), result);
      break;
    }
    case Kind::free: {
      if (excitation.deflection.value_or(0.0) == 0.0 && excitation.velocity == 0.0)
        throw InputError(
            excitation.place,
            "an excitation of kind \"none\" causes no motion; expected deflection_m or velocity_m_per_s");
      const VectorXd unit = shape(c);
      result.loading.initial_displacement = excitation.deflection.value_or(0.0) * unit;
      result.loading.initial_velocity = excitation.velocity * unit;
      break;
    }
    case Kind::step:
      set_input(c, input, VectorXd::Constant(grid.samples, excitation.force), result);
      break;
    case Kind::impulse:
      if (excitation.duration > 0.0)
        set_input(c, input, half_sine(c), result);
      else
        result.loading.initial_velocity = struck(c);
      break;
    case Kind::harmonic:
      set_input(c, input, sine(c, result.notes), result);
      break;
    case Kind::random:
      set_input(c, input, random_force(c), result);
      break;
    case Kind::table:
      set_input(c, input, from_file(c, result.notes), result);
      break;
    case Kind::base:
      result.base_acceleration = excitation.file ? from_file(c, result.notes) : sine(c, result.notes);
      set_input(c, system.inputs.cols() - 1, result.base_acceleration, result);
      break;
  }
  return result;
}

void add(const ExcitationHistory& further, ExcitationHistory& to) {
  if (to.loading.inputs.size() == 0)
    to.loading.inputs = further.loading.inputs;
  else if (further.loading.inputs.size() > 0)
    to.loading.inputs += further.loading.inputs;
  if (further.base_acceleration.size() > 0) to.base_acceleration = further.base_acceleration;
  to.notes.insert(to.notes.end(), further.notes.begin(), further.notes.end());
}

}  // namespace beamid::experiments
