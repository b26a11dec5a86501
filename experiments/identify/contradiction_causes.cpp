#include "experiments/identify/contradiction_causes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "experiments/identify/mode_residual.hpp"
#include "experiments/modal/shape_fit.hpp"
#include "experiments/models/discretisation_bias.hpp"
#include "experiments/record/prepare/analysable_record.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;

Oscillator modal_oscillator(const RecordIdentification& found) {
  return Oscillator::from_frequency(found.model.equivalent_mass,
                                    2.0 * std::numbers::pi * found.modal.frequency_hz,
                                    found.modal.damping_ratio);
}

// "964 % too large"
std::string error_text(double percent_off) {
  return fmt::format("{:.3g} % too {}", std::abs(percent_off), percent_off > 0 ? "large" : "small");
}

// Root mean square of what modes leave of the first channel.
double left_by(const Record& even, const std::vector<Complex>& modes) {
  const Eigen::MatrixXd first =
      with_mode_in_gaps(even.samples.row(0).transpose(), even.interval(), modes[0]).transpose();
  std::vector<Complex> rates = modes;
  std::vector<bool> oscillating(modes.size(), true);
  rates.emplace_back(0.0);
  oscillating.push_back(false);
  const ShapeFit fit = fit_shapes(first, even.interval(), rates, oscillating);
  return (first - fit.reconstruction).norm() / std::sqrt(static_cast<double>(first.cols()));
}

}  // namespace

std::string by_discretisation(const Record& record, const RecordIdentification& found) {
  constexpr double explained = 0.1;  // of the difference that may be left
  const std::string& scheme = found.settings.discretisation;
  const Oscillator modal = modal_oscillator(found), &filter = found.identification.found;
  const double interval = record.interval();
  try {
    const Oscillator seen = seen_through(scheme, modal, interval);
    const double predicted = seen.damping - modal.damping, difference = filter.damping - modal.damping;
    const double about = quantile_95 * found.damping_factor() * found.identification.damping_deviation;
    if (!(std::abs(predicted) > 1e-3 * std::abs(modal.damping)) ||
        std::abs(difference - predicted) > explained * std::abs(predicted) + about)
      return {};
    return fmt::format("{} at {:.4g} ms makes C {} and K {}, whatever the filter: use exponential", scheme,
                       1e3 * interval, error_text(percent(seen.damping, modal.damping)),
                       error_text(percent(seen.stiffness, modal.stiffness)));
  } catch (const std::exception&) {  // no oscillation, or a step too long for the scheme
    return {};
  }
}

std::string by_prior(const Prior& prior, const RecordIdentification& found) {
  constexpr double surely = 3;
  const Oscillator modal = modal_oscillator(found);
  if (prior.damping_ratio && prior.damping_ratio_deviation &&
      std::abs(*prior.damping_ratio - found.modal.damping_ratio) > surely * *prior.damping_ratio_deviation)
    return fmt::format("prior.damping_ratio, {:g} +- {:g}, excludes it", *prior.damping_ratio,
                       *prior.damping_ratio_deviation);
  if (prior.stiffness && prior.stiffness_deviation &&
      std::abs(*prior.stiffness - modal.stiffness) > surely * *prior.stiffness_deviation)
    return fmt::format("prior.stiffness_n_per_m, {:g} +- {:g}, excludes it", *prior.stiffness,
                       *prior.stiffness_deviation);
  return {};
}

std::string by_stated_noise(const RecordIdentification& found) {
  constexpr double far = 10;
  const double ratio = found.near_mode.deviation / found.noise_deviation[0];
  if (found.noise_from_record[0] || !(ratio > far)) return {};
  return fmt::format("[noise] states {:.3g} for the first channel, where the record has {:.3g} near the mode",
                     found.noise_deviation[0], found.near_mode.deviation);
}

std::string by_companion(const RecordIdentification& found) {
  if (found.modal.companions.empty()) return {};
  const CompanionMode& other = found.modal.companions.front();
  return fmt::format(
      "another mode at {:.2f} Hz has {:.0f} % of this one's amplitude, and a model of one mode takes its "
      "decay and beat for damping",
      other.frequency_hz, 100.0 * other.amplitude / found.modal.amplitude);
}

std::string by_amplitude(const RecordIdentification& found) {
  const AmplitudeSections& by = found.sections;
  if (by.damping.varies())
    return fmt::format("the damping ratio depends on amplitude, {:.4g} % at first and {:.4g} % at last",
                       100.0 * by.damping.values[0], 100.0 * by.damping.values[by.damping.values.size() - 1]);
  if (by.frequency.varies())
    return fmt::format("the frequency depends on amplitude, {:.6g} Hz at first and {:.6g} Hz at last",
                       by.frequency.values[0], by.frequency.values[by.frequency.values.size() - 1]);
  return {};
}

std::string by_unsteady_noise(const RecordIdentification& found) {
  constexpr double much = 10;  // of the variance, first windows against last ones
  if (!found.consistency || found.consistency->windows.size() < 4) return {};
  const auto& windows = found.consistency->windows;
  const double first = windows.head(2).mean(), last = windows.tail(2).mean();
  if (!(first > much * last)) return {};
  return fmt::format(
      "what the model cannot follow is {:.2g} times as large at the beginning as at the end: rattle, "
      "saturation, or modes that die out; try a later window",
      std::sqrt(first / last));
}

bool modal_analysis_is_worse(const Record& record, const RecordIdentification& found) {
  constexpr double clearly = 1.02;
  if (!(found.identification.found.damping_ratio() < 1.0)) return false;
  std::vector<Complex> modes{found.modal.rate()};
  for (const CompanionMode& other : found.modal.companions) modes.push_back(other.rate());
  const Record even = on_even_stamps(record).record;
  return left_by(even, modes) > clearly * left_by(even, {found.identification.found.eigenvalue()});
}

std::string cause_of(const Experiment& experiment, const Record& record, const RecordIdentification& found) {
  for (const std::string& text :
       {by_discretisation(record, found), by_prior(experiment.prior, found), by_stated_noise(found),
        by_companion(found), by_amplitude(found), by_unsteady_noise(found)})
    if (!text.empty()) return text;
  return {};
}

std::string by_overtone(const RecordIdentification& found) {
  constexpr double least_share = 0.1, near = 0.02;
  for (const CompanionMode& other : found.modal.companions) {
    const double times = other.frequency_hz / found.modal.frequency_hz,
                 share = other.amplitude / found.modal.amplitude;
    const double whole = std::round(times);
    if (whole < 2 || std::abs(times - whole) > near || share < least_share) continue;
    return fmt::format(
        "An overtone at {:.4g} Hz, {:.0f} times the frequency, has {:.0f} % of the amplitude: clipped "
        "readings or a stiffness that is not linear",
        other.frequency_hz, whole, 100.0 * share);
  }
  return {};
}

}  // namespace beamid::experiments
