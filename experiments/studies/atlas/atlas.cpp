#include "experiments/studies/atlas/atlas.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/studies/paper/numerical_validation.hpp"
#include "experiments/text/countdown.hpp"

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

}  // namespace beamid::experiments
