#include "experiments/studies/atlas/atlas.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/models/oscillator.hpp"
#include "experiments/studies/paper/numerical_validation.hpp"
#include "experiments/text/progress.hpp"
#include "filters/filter_run.hpp"
#include "filters/step_input.hpp"

namespace beamid::experiments {
namespace {

constexpr double finest_atlas_step = 1e-3, per_decade = 20.0;  // steps of the map [rad]
constexpr int measured_every = 10;                             // of them
constexpr double most_atlas_samples = 20000, fewest_atlas_samples = 400;
constexpr double decayed = 9.0;  // e-folds of amplitude: what is left is below the noise assumed

Bias bias_of(const Oscillator& found, const Oscillator& truth) {
  return {percent(found.stiffness, truth.stiffness), percent(found.damping, truth.damping)};
}

Oscillator unit_oscillator(double damping_ratio) {
  return Oscillator::from_frequency(1.0, 1.0, damping_ratio);
}

AtlasPoint point(const std::string& scheme, const Oscillator& truth, double dt, bool measure) {
  AtlasPoint result{
      scheme, truth.damping_ratio(), truth.angular_frequency() * dt, predicted_bias(scheme, truth, dt), {}};
  if (measure && result.predicted) result.measured = measured_bias(scheme, truth, dt);
  return result;
}

}  // namespace

std::optional<Bias> predicted_bias(const std::string& scheme, const Oscillator& truth, double dt) {
  try {
    return bias_of(seen_through(scheme, truth, dt), truth);
  } catch (const std::runtime_error&) {
    return {};
  }
}

std::optional<Bias> measured_bias(const std::string& scheme, const Oscillator& truth, double dt) {
  const double w = truth.angular_frequency();
  const double samples =
      std::clamp(decayed / (truth.damping_ratio() * w * dt), fewest_atlas_samples, most_atlas_samples);
  paper::ValidationSettings settings = paper::bias_settings();
  settings.truth = truth;
  settings.interval = dt;
  settings.duration = std::floor(samples) * dt;
  settings.passes = 3;
  // As uncertain as K is, and C by as much as a first-order scheme may change it, K dt; then less and less,
  // so that the products of these uncertainties with those of the start, which a linearisation drops, vanish
  // too.
  const double c = std::max(truth.damping, truth.stiffness * dt);
  Oscillator found = truth;
  for (const double uncertainty : {1.0, 1e-2, 1e-4}) {
    settings.first_stiffness = found.stiffness;
    settings.first_damping = found.damping;
    settings.initial_variance = {1.0, w * w, std::pow(uncertainty * truth.stiffness, 2),
                                 std::pow(uncertainty * c, 2)};
    const Identification identified = paper::validate("ekf", scheme, settings);
    if (identified.run.failure) return {};
    found = identified.found;
  }
  return bias_of(found, truth);
}

double harmless_step(const std::string& scheme, double damping_ratio, double percent) {
  const Oscillator truth = unit_oscillator(damping_ratio);
  const auto harmless = [&](double step) {
    const auto bias = predicted_bias(scheme, truth, step);
    return bias && std::abs(bias->damping_percent) <= percent;
  };
  constexpr double ratio = 1.02;
  double step = 1e-7;
  if (!harmless(step)) return 0.0;
  while (step < std::numbers::pi && harmless(step * ratio)) step *= ratio;
  if (step >= std::numbers::pi) return std::numeric_limits<double>::infinity();
  double low = step, high = step * ratio;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (harmless(middle) ? low : high) = middle;
  }
  return low;
}

Atlas make_atlas(const AtlasSettings& settings, const Progress& progress) {
  const Oscillator& beam = settings.beam;
  const double step = beam.angular_frequency() * settings.interval;
  if (!(step > 0.0 && step < std::numbers::pi))
    throw std::invalid_argument("interval is " + std::to_string(settings.interval) + " s, " +
                                std::to_string(step) +
                                " rad of the motion; expected above 0 and less than half a period");
  Atlas atlas{settings, {}, {}};
  Countdown countdown(progress, paper::compared_schemes().size() * settings.damping_ratios.size(), "rows");
  for (const std::string& scheme : paper::compared_schemes()) {
    countdown.begin(scheme);
    atlas.own.push_back(point(scheme, beam, settings.interval, true));
    for (const double ratio : settings.damping_ratios) {
      const int last = static_cast<int>(per_decade * std::log10(2.0 / finest_atlas_step));
      for (int k = 0; k <= last; ++k)
        atlas.map.push_back(point(scheme, unit_oscillator(ratio),
                                  finest_atlas_step * std::pow(10.0, k / per_decade),
                                  k >= 2 * measured_every && k % measured_every == 0));
      countdown.count();
    }
  }
  return atlas;
}

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
