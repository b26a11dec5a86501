#include "experiments/studies/atlas/input_hold.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/models/oscillator.hpp"
#include "filters/filter_run.hpp"
#include "filters/input_path.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using Complex = std::complex<double>;

constexpr InputPath hold_paths[] = {InputPath::held, InputPath::linear, InputPath::band_limited};

void refuse_unless_sampled(const Oscillator& mode, double dt) {
  const double step = mode.angular_frequency() * dt;
  if (!(mode.damping_ratio() > 0.0 && mode.damping_ratio() < 1.0) || !(step > 0.0 && step < std::numbers::pi))
    throw std::invalid_argument("damping ratio " + std::to_string(mode.damping_ratio()) + ", " +
                                std::to_string(step) +
                                " rad a step; expected a damped oscillation and less than half a period");
}

// H of a filter's own oscillator between samples, at e^(i theta): the sum over its poles lambda, residues
// 1 / (M (lambda - lambda*)), of q_k+1 = e^(lambda dt) q_k + b_0 u_k + b_1 (u_k+1 - u_k).
Complex sampled_response(InputPath path, const Oscillator& found, double theta, double dt) {
  const Complex turn = std::polar(1.0, theta), pole = found.eigenvalue();
  Complex sum = 0.0;
  for (const Complex lambda : {pole, std::conj(pole)}) {
    const Complex moved = std::exp(lambda * dt), held = (moved - 1.0) / lambda,
                  straight = (moved - 1.0 - lambda * dt) / (lambda * lambda * dt),
                  input = path == InputPath::held ? held : held + straight * (turn - 1.0);
    sum += input / (turn - moved) / (found.mass * (lambda - std::conj(lambda)));
  }
  return sum;
}

// The part of a sampled cos(w t) at w itself.
Complex part_at_its_frequency(InputPath path, double theta) {
  const double p = 0.5 * theta, sinc = std::sin(p) / p;
  return path == InputPath::held ? sinc * std::polar(1.0, -p) : Complex(sinc * sinc);
}

int degree_of(InputPath path) {
  constexpr int band_limited = 4;
  return path == InputPath::held ? 0 : path == InputPath::linear ? 1 : band_limited;
}

/// Displacement under the force, in steady motion at the resonance.
struct SteadyRecord {
  VectorXd time;
  MatrixXd motion, force;  // (1 x N)
  double size;             // of the displacement
};

SteadyRecord steady_record(const Oscillator& mode, double dt) {
  constexpr double periods = 40.0;
  const double w = mode.angular_frequency();
  const auto count = static_cast<Index>(std::lround(periods * 2.0 * std::numbers::pi / (w * dt))) + 1;
  SteadyRecord made{VectorXd::LinSpaced(count, 0.0, dt * static_cast<double>(count - 1)), MatrixXd(1, count),
                    MatrixXd(1, count), 1.0 / (mode.damping * w)};
  for (Index k = 0; k < count; ++k) {  // x = Re(e^(i w t) / (i C w))
    made.motion(0, k) = made.size * std::sin(w * made.time[k]);
    made.force(0, k) = std::cos(w * made.time[k]);
  }
  return made;
}

JointModel forced_model(const Oscillator& mode) {
  ModelSetting setting = at_one_point(one_coordinate(mode), {Quantity::displacement});
  setting.forces = {0};
  return *model_registry().make("sdof", {{"sensor_bias", false}}, setting);
}

}  // namespace

Bias predicted_hold_bias(InputPath path, const Oscillator& mode, double dt) {
  refuse_unless_sampled(mode, dt);
  if (path == InputPath::band_limited) return {};
  constexpr double exact = 1e-15;
  constexpr int most = 200;
  const double w = mode.angular_frequency(), theta = w * dt;
  const Complex part = part_at_its_frequency(path, theta), wanted(0.0, mode.damping * w);
  Oscillator found = mode;
  // 1/G is nearly (K' - M w^2 + i C' w) / P: what of the force lies at other frequencies is far above the
  // resonance.
  for (int k = 0; k < most; ++k) {
    const Complex missing = part * (wanted - 1.0 / sampled_response(path, found, theta, dt));
    found.stiffness += missing.real();
    found.damping += missing.imag() / w;
    if (std::abs(missing) < exact * std::abs(wanted)) break;
  }
  return {percent(found.stiffness, mode.stiffness), percent(found.damping, mode.damping)};
}

std::optional<Bias> measured_hold_bias(InputPath path, const Oscillator& mode, double dt) {
  refuse_unless_sampled(mode, dt);
  const SteadyRecord record = steady_record(mode, dt);
  const JointModel model = forced_model(mode);
  const double w = mode.angular_frequency(), noise = 1e-6 * record.size;
  filters::Measurements measured{record.time, record.motion, {}};
  measured.inputs = filters::input_path(degree_of(path), record.time, record.force, 1e-6 * dt).columns;
  VectorXd state(5), scale(5);
  state << 0.0, w * record.size, mode.stiffness, mode.damping, mode.mass;
  // As uncertain as the bias may be, then less and less: what a linearisation drops vanishes too.
  scale << record.size, w * record.size, mode.damping * w, mode.damping, 0.0;
  for (const double share : {1.0, 1e-2, 1e-4}) {
    const auto filter = filters::filter_registry().make(
        "ekf", {},
        filters::discretise(model.motion, dt, "exponential", {{}, MatrixXd::Constant(1, 1, noise * noise)}));
    const VectorXd deviation =
        (Eigen::Array<double, 5, 1>(1.0, 1.0, share, share, 0.0) * scale.array()).matrix();
    const filters::Gaussian initial{state, MatrixXd(deviation.cwiseAbs2().asDiagonal())};
    const filters::FilterRun run = filters::run(*filter, initial, measured);
    if (run.failure) return {};
    state.segment<2>(2) = run.last.mean.segment<2>(2);
  }
  return Bias{percent(state[2], mode.stiffness), percent(state[3], mode.damping)};
}

HoldPage make_hold_page(const AtlasSettings& settings, const Progress& progress) {
  progress("inputs between samples");
  const Oscillator& mode = settings.beam;
  const double period = 2.0 * std::numbers::pi / mode.angular_frequency();
  const auto point = [&](InputPath path, double samples, bool measure) {
    const double dt = period / samples;
    return HoldPoint{path, samples, predicted_hold_bias(path, mode, dt),
                     measure ? measured_hold_bias(path, mode, dt) : std::nullopt};
  };
  HoldPage page;
  constexpr int per_factor = 4, points = 24;  // a factor of two in samples per period, from 4 to 256
  for (const InputPath path : hold_paths) {
    page.own.push_back(point(path, period / settings.interval, true));
    for (int k = 0; k <= points; ++k)
      page.map.push_back(
          point(path, 4.0 * std::pow(2.0, static_cast<double>(k) / per_factor), k % per_factor == 0));
  }
  return page;
}

}  // namespace beamid::experiments
