#include "experiments/studies/budget/budget.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <stdexcept>

#include <tbb/parallel_for.h>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/models/identification.hpp"
#include "experiments/models/oscillator.hpp"
#include "experiments/signal/butterworth.hpp"
#include "experiments/signal/integration.hpp"
#include "experiments/signal/toolbox.hpp"
#include "experiments/text/progress.hpp"
#include "fem/assembly.hpp"
#include "fem/free_decay.hpp"
#include "fem/stiffness_solver.hpp"
#include "filters/fisher_information.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double processed_variance = 1e-5;  // R of displacement [m2] and velocity [m2/s2], as the paper
constexpr double settled_transient = 1e-5;   // of the high-pass's transient, where it is left out
constexpr int clean_passes = 3;

// x'' of x'' + 2 xi w x' + q |x'| x' + w^2 x = 0 from rest at a, by the classical Runge-Kutta step, of which
// 2 pi / (w dt) make a period: its own damping is (w dt)^5 / 144 at most.
VectorXd quadratic_decay(double a, double w, double xi, double q, const VectorXd& time) {
  const auto rate = [&](const Eigen::Vector2d& z) {
    return Eigen::Vector2d(z[1], -2.0 * xi * w * z[1] - q * std::abs(z[1]) * z[1] - w * w * z[0]);
  };
  VectorXd result(time.size());
  Eigen::Vector2d z(a, 0.0);
  const double dt = time[1] - time[0];
  for (Index k = 0; k < time.size(); ++k) {
    const Eigen::Vector2d k1 = rate(z), k2 = rate(z + 0.5 * dt * k1), k3 = rate(z + 0.5 * dt * k2),
                          k4 = rate(z + dt * k3);
    result[k] = k1[1];
    z += dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return result;
}

VectorXd instants(const PipelineSettings& settings, bool stated_rate) {
  const double rate = (stated_rate ? 1.0 : 2.0) * settings.sampling_rate;
  const auto count = static_cast<Index>(std::lround(settings.duration * rate)) + 1;
  return VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1)) / rate;
}

}  // namespace

Pipeline::Pipeline(PipelineSettings settings) : settings_(std::move(settings)) {
  if (settings_.damping_ratios.size() == 0)
    throw std::invalid_argument("damping_ratios: none; expected one per mode");
  require_positive(settings_.damping_ratios[0], "damping ratio of the first mode");
  require_positive(settings_.deflection, "deflection");
  require_positive(settings_.sensor_noise, "sensor_noise");
  fem::StructuralSystem system = fem::assemble(settings_.beam, settings_.elements);
  bare_ = shape(system);
  const double frequency = bare_.frequencies[0] / (2.0 * std::numbers::pi);
  if (!(settings_.sampling_rate > 4.0 * frequency) || !(settings_.duration * frequency > 20.0))
    throw std::invalid_argument("record of " + std::to_string(settings_.duration) + " s at " +
                                std::to_string(settings_.sampling_rate) + " Hz of a mode at " +
                                std::to_string(frequency) +
                                " Hz; expected 20 periods and 4 samples in each at least");
  const fem::Modes first = fem::modes(system, 1);
  const double at_point = (system.outputs.row(0) * first.shape.col(0))(0);
  truth_ = Oscillator::from_frequency(1.0 / (at_point * at_point), first.angular_frequency[0],
                                      settings_.damping_ratios[0]);
  const auto rayleigh = reduction::reduction_registry().make("rayleigh", {});
  const auto model = model_registry().make(
      "sdof", {}, at_one_point(reduce(system, *rayleigh).system, {Quantity::acceleration}));
  rayleigh_mass_ = model->equivalent_mass;
  fem::Beam with_sensor = settings_.beam;
  with_sensor.bodies.push_back({fem::natural_point(settings_.beam).position, settings_.sensor_mass, 0, 0});
  system = fem::assemble(with_sensor, settings_.elements);
  loaded_ = shape(system);
  // A mass adds no damping: C of the first mode stays what it was.
  const fem::Modes slower = fem::modes(system, 1);
  const double mass = 1.0 / std::pow((system.outputs.row(0) * slower.shape.col(0))(0), 2);
  loaded_.ratios[0] = truth_.damping / (2.0 * slower.angular_frequency[0] * mass);
}

Pipeline::Shape Pipeline::shape(const fem::StructuralSystem& system) const {
  const fem::Modes modes = fem::modes(system, settings_.damping_ratios.size());
  return {fem::modal_amplitudes(system, modes, settings_.deflection * fem::static_shape(system)),
          modes.angular_frequency, settings_.damping_ratios};
}

Pipeline::Acceleration Pipeline::acceleration(const Causes& on, const VectorXd& time) const {
  const auto has = [&](Cause cause) { return on.test(index_of(cause)); };
  const Shape& shape = has(Cause::sensor_mass) ? loaded_ : bare_;
  const auto motion = [&](Index from, Index count) {
    return fem::free_decay(shape.amplitudes.segment(from, count), shape.frequencies.segment(from, count),
                           shape.ratios.segment(from, count), time)
        .acceleration;
  };
  Acceleration result{{}, std::pow(settings_.sensor_noise, 2)};
  if (has(Cause::amplitude_damping)) {
    // 8 q w a / (3 pi) is the viscous rate that takes as much energy at amplitude a.
    const double a = shape.amplitudes[0], xi = shape.ratios[0];
    const double q = 0.75 * std::numbers::pi * settings_.amplitude_damping * xi / std::abs(a);
    result.samples = quadratic_decay(a, shape.frequencies[0], xi, q, time);
  } else {
    result.samples = motion(0, 1);
  }
  const Index modes = shape.amplitudes.size() - 1;
  if (has(Cause::higher_modes) && modes > 0) {
    const VectorXd higher = motion(1, modes);
    result.samples += higher;
    // Over a period of the first mode they are one witness and not as many as it has samples.
    const double period = 2.0 * std::numbers::pi / shape.frequencies[0];
    result.variance += higher.squaredNorm() / static_cast<double>(time.size()) * period / (time[1] - time[0]);
  }
  if (has(Cause::sensor_noise))
    result.samples += settings_.sensor_noise * standard_normal(time.size(), settings_.seed, settings_.stream);
  if (has(Cause::sensor_bias)) result.samples.array() += settings_.sensor_bias;
  return result;
}

ParameterErrors Pipeline::errors(const Causes& on) const {
  const auto has = [&](Cause cause) { return on.test(index_of(cause)); };
  const VectorXd time = instants(settings_, has(Cause::sampling));
  const auto [measured, variance_of_noise] = acceleration(on, time);
  const double dt = time[1] - time[0];
  const Oscillator model_truth{has(Cause::reduction) ? rayleigh_mass_ : truth_.mass, truth_.stiffness,
                               truth_.damping};
  filters::Measurements record;
  IdentificationSettings identification;
  std::vector<Quantity> observed{Quantity::acceleration};
  const double first_stiffness = 0.8 * truth_.stiffness, first_damping = 3.0 * truth_.damping;
  const double size = std::abs(bare_.amplitudes[0]), w = truth_.angular_frequency();
  Eigen::Vector2d start;
  if (has(Cause::integration)) {
    observed = {Quantity::displacement, Quantity::velocity};
    ProcessingSettings processing;
    processing.high_pass_hz = settings_.high_pass_hz;
    processing.transient_tolerance = settled_transient;
    const ProcessedMotion motion = process_acceleration(measured, dt, processing);
    const Index first = has(Cause::high_pass) ? 0 : motion.settled_begin, count = time.size() - first;
    if (count < 16)
      throw std::invalid_argument("duration: " + std::to_string(settings_.duration) +
                                  " s; expected more than the high-pass takes to settle");
    record = {time.tail(count), Eigen::MatrixXd(2, count), {}};
    record.outputs << motion.displacement.tail(count).transpose(), motion.velocity.tail(count).transpose();
    identification.output_noise = processed_variance * Eigen::Matrix2d::Identity();
    start = record.outputs.col(0);
  } else {
    record = {time, measured.transpose(), {}};
    if (has(Cause::high_pass))
      record.outputs =
          filter_causally(butterworth_high_pass(2, settings_.high_pass_hz, dt), measured).transpose();
    identification.output_noise.setConstant(1, 1, variance_of_noise);
    start = {settings_.deflection, 0.0};  // as pulled: the first acceleration is that of all modes
  }
  identification.initial.mean = Eigen::Vector4d(start[0], start[1], first_stiffness, first_damping);
  Eigen::Vector4d variance(1.0, 1.0, 1e5, 1e5);
  if (!has(Cause::initial_covariance))  // C may err by as much as a first-order scheme makes of it, K dt
    variance << size * size, std::pow(w * size, 2), std::pow(0.3 * truth_.stiffness, 2),
        std::pow(3.0 * truth_.damping + truth_.stiffness * dt, 2);
  identification.initial.covariance = variance.asDiagonal();
  identification.discretisation = has(Cause::discretisation) ? "forward_euler" : "exponential";
  identification.passes = has(Cause::linearisation) ? 1 : clean_passes;
  const auto model = model_registry().make("sdof", {{"sensor_bias", false}},
                                           at_one_point(one_coordinate(model_truth), observed));
  const Identification found = identify(*model, record, identification);
  // No cause here moves K by as much as another mode would.
  constexpr double another_mode = 20.0;  // [%]
  if (found.run.failure || !(std::abs(percent(found.found.stiffness, truth_.stiffness)) < another_mode))
    return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  return {percent(found.found.stiffness, truth_.stiffness), percent(found.found.damping, truth_.damping)};
}

ParameterErrors Pipeline::reduction() const {
  const double error = percent(rayleigh_mass_, truth_.mass);
  return {error, error};
}

ParameterErrors Pipeline::discretisation(double interval) const {
  const Oscillator seen = seen_through("forward_euler", truth_, interval);
  return {percent(seen.stiffness, truth_.stiffness), percent(seen.damping, truth_.damping)};
}

ParameterErrors Pipeline::noise_bound() const {
  const VectorXd time = instants(settings_, false);
  const auto model = model_registry().make("sdof", {{"sensor_bias", false}},
                                           at_one_point(one_coordinate(truth_), {Quantity::acceleration}));
  const auto discrete =
      filters::discretise(model->motion, time[1] - time[0], "exponential",
                          {{}, Eigen::MatrixXd::Constant(1, 1, std::pow(settings_.sensor_noise, 2))});
  const Eigen::Vector4d state(bare_.amplitudes[0], 0.0, truth_.stiffness, truth_.damping);
  const Eigen::Vector2d bound =
      filters::cramer_rao_bound(filters::fisher_information(*discrete, state, time.size())).tail<2>();
  return {100.0 * bound[0] / truth_.stiffness, 100.0 * bound[1] / truth_.damping};
}

namespace {

using Order = std::vector<std::size_t>;

std::vector<Order> chosen_orders(int count, std::uint64_t seed) {
  Order order(cause_count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<Order> orders;
  filters::RandomStream random(seed, ~std::uint64_t{0});  // apart from the streams of noise
  while (static_cast<int>(orders.size()) < count) {
    orders.push_back(order);
    orders.emplace_back(order.rbegin(), order.rend());
    for (std::size_t i = cause_count - 1; i > 0; --i)
      std::swap(order[i], order[static_cast<std::size_t>(random.uniform() * static_cast<double>(i + 1))]);
  }
  return orders;
}

// The sets that an order passes through, from none to all.
std::vector<Causes> chain(const Order& order) {
  std::vector<Causes> sets{Causes()};
  for (const std::size_t i : order) sets.push_back(Causes(sets.back()).set(i));
  return sets;
}

}  // namespace

Budget make_budget(const std::string& name, const PipelineSettings& settings, int orders,
                   const Progress& progress) {
  if (orders < 2) throw std::invalid_argument("orders: " + std::to_string(orders) + "; expected 2 or more");
  Budget budget{name, Pipeline(settings), {}, {}, std::vector<Contribution>(cause_count), {}, 0};
  const std::vector<Order> sequences = chosen_orders(orders, settings.seed);

  std::set<unsigned long> needed;
  for (const Order& order : sequences)
    for (const Causes& on : chain(order)) needed.insert(on.to_ulong());
  for (std::size_t i = 0; i < cause_count; ++i) {
    needed.insert(Causes().set(i).to_ulong());
    needed.insert(all_causes().reset(i).to_ulong());
  }
  const std::vector<unsigned long> sets(needed.begin(), needed.end());
  std::vector<ParameterErrors> found(sets.size());
  Countdown countdown(progress, sets.size(), "runs");
  countdown.begin(name);
  tbb::parallel_for(std::size_t{0}, sets.size(), [&](std::size_t i) {
    found[i] = budget.pipeline.errors(Causes(sets[i]));
    countdown.count();
  });
  std::map<unsigned long, ParameterErrors> errors;
  for (std::size_t i = 0; i < sets.size(); ++i) errors[sets[i]] = found[i];
  const auto error = [&](const Causes& on) { return errors.at(on.to_ulong()); };

  budget.runs = static_cast<int>(sets.size());
  budget.clean = error({});
  budget.total = budget.interaction = error(all_causes());
  budget.interaction = budget.interaction - budget.clean;
  for (std::size_t i = 0; i < cause_count; ++i) {
    Contribution& share = budget.contributions[i];
    share.alone = error(Causes().set(i)) - budget.clean;
    share.without = budget.total - error(all_causes().reset(i));
    budget.interaction = budget.interaction - share.alone;
  }
  for (const Order& order : sequences) {
    const std::vector<Causes> stages = chain(order);
    for (std::size_t step = 0; step < cause_count; ++step) {
      const ParameterErrors added = error(stages[step + 1]) - error(stages[step]);
      Contribution& share = budget.contributions[order[step]];
      if (&order == &sequences.front()) share.in_sequence = added;
      share.average = share.average + added / static_cast<double>(sequences.size());
    }
  }
  return budget;
}

std::size_t largest(const std::vector<Contribution>& contributions, ParameterErrors Contribution::*way,
                    double ParameterErrors::*parameter) {
  const auto size = [&](const Contribution& c) { return std::abs(c.*way.*parameter); };
  const auto found = std::max_element(contributions.begin(), contributions.end(),
                                      [&](const auto& a, const auto& b) { return size(a) < size(b); });
  return static_cast<std::size_t>(found - contributions.begin());
}

}  // namespace beamid::experiments
