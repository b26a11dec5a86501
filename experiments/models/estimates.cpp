#include "experiments/models/estimates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "experiments/models/discretisation_bias.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::VectorXd;

std::vector<Estimate> estimates(const JointModel& model, const filters::Gaussian& estimate) {
  std::vector<Estimate> result;
  for (std::size_t j = 0; j < model.unknowns.size(); ++j) {
    const Unknown& unknown = model.unknowns[j];
    const Index place = model.unknown_places[j];
    const double mean = estimate.mean[place], deviation = std::sqrt(estimate.marginal(place, 1)(0, 0));
    result.push_back({unknown.name, unknown.unit, unknown.to_physical(mean),
                      std::abs(unknown.slope(mean)) * deviation,
                      unknown.to_physical(mean - quantile_95 * deviation),
                      unknown.to_physical(mean + quantile_95 * deviation), unknown.guess, unknown.deviation,
                      unknown.nuisance});
  }
  return result;
}

VectorXd unknown_values(const JointModel& model, const VectorXd& state) {
  VectorXd values(static_cast<Index>(model.unknowns.size()));
  for (Index j = 0; j < values.size(); ++j)
    values[j] = model.unknowns[j].to_physical(state[model.unknown_places[j]]);
  return values;
}

std::string divergence(const FoundMode& found, std::optional<double> record_hz) {
  if (!(found.frequency_hz > 0.0) || !std::isfinite(found.frequency_hz))
    return "its stiffness is not positive: there is no oscillation";
  constexpr double rounding = 1e-9;  // of a ratio: an undamped motion does not grow
  if (!(found.damping_ratio + quantile_95 * found.damping_ratio_deviation >= -rounding))
    return fmt::format("its damping ratio is {:.3g} %: the motion would grow", 100.0 * found.damping_ratio);
  if (!record_hz || std::abs(found.frequency_hz / *record_hz - 1.0) < same_motion) return {};
  return fmt::format("it moves at {:.4g} Hz where the record has {:.4g} Hz", found.frequency_hz, *record_hz);
}

std::string divergence(const Identification& result, std::optional<double> record_hz) {
  if (result.run.failure) return failure_text(*result.run.failure);
  const Oscillator& found = result.found;
  FoundMode mode;
  mode.frequency_hz = found.stiffness > 0.0 ? found.frequency_hz() : 0.0;
  mode.damping_ratio = found.damping_ratio();
  mode.damping_ratio_deviation = result.damping_ratio_deviation;
  return divergence(mode, record_hz);
}

std::string failure_text(const filters::Failure& failure) {
  return fmt::format("sample {}, {:.4f} s: {}{}", failure.step, failure.time, failure.reason,
                     std::isnan(failure.smallest_eigenvalue)
                         ? ""
                         : fmt::format(" (smallest eigenvalue {:.1g})", failure.smallest_eigenvalue));
}

std::string step_too_long(const std::string& scheme, const FoundMode& mode, double interval) {
  constexpr double least = 1e-3;  // of a damping ratio that is worth a word
  if (!(std::abs(mode.damping_ratio) < 1.0)) return {};
  const double omega = 2.0 * std::numbers::pi * mode.frequency_hz;
  const std::string step = fmt::format("{} with steps of {:.4g} s, {:.3g} of them a period", scheme, interval,
                                       1.0 / (mode.frequency_hz * interval));
  const std::string cure = "The step is too long; discretisation exponential is exact.";
  const Oscillator truth = Oscillator::from_frequency(1.0, omega, mode.damping_ratio);
  FoundMode seen;
  try {
    const Oscillator found = seen_through(scheme, truth, interval);
    seen.frequency_hz = found.frequency_hz();
    seen.damping_ratio = found.damping_ratio();
  } catch (const std::runtime_error&) {
    return fmt::format("{}, has no motion like that of a mode at {:.4g} Hz. {}", step, mode.frequency_hz,
                       cure);
  }
  const bool doubled =
      std::abs(seen.damping_ratio - mode.damping_ratio) > std::max(least, std::abs(mode.damping_ratio));
  if (std::abs(seen.frequency_hz / mode.frequency_hz - 1.0) < same_motion && !doubled) return {};
  return fmt::format(
      "{}, finds a mode of {:.4g} Hz and {:.3g} % as one of {:.4g} Hz and {:.3g} %, whatever the filter. {}",
      step, mode.frequency_hz, 100.0 * mode.damping_ratio, seen.frequency_hz, 100.0 * seen.damping_ratio,
      cure);
}

}  // namespace beamid::experiments
