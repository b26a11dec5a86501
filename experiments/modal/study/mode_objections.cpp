#include "experiments/modal/study/mode_objections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

double duration_of(const RecordModes& found) {
  return found.interval * static_cast<double>(found.target.cols());
}

/// sum over channels and samples of y^2 / s^2.
double energy_over_noise(const JointDecayFit& fit, Index m, const RecordModes& found) {
  double energy = 0;
  for (Index k = 0; k < found.target.cols(); ++k) {
    const std::complex<double> wave = std::exp(fit.rates[m] * (found.interval * static_cast<double>(k)));
    for (Index c = 0; c < fit.shapes.rows(); ++c)
      energy += std::pow((fit.shapes(c, m) * wave).real(), 2) / std::max(fit.noise_variance(c, m), 1e-300);
  }
  return energy;
}

double energy_of_noise(const RecordModes& found) {
  constexpr double by_chance = 1e-3;
  const double resolutions = std::max(1.0, (found.band_hz.second - found.band_hz.first) * duration_of(found));
  return chi_square_limit(2.0 * static_cast<double>(found.target.rows()) + 2, 1.0 - by_chance / resolutions);
}

/// Whether a mode is so large a part of some channel that no noise is like it: what a damped sine takes of
/// white noise of N samples is some 30 / N. What is left of a mode that drifts lies near it and is no noise.
bool dominates(const JointDecayFit& fit, Index m, const RecordModes& found) {
  const auto count = static_cast<double>(found.target.cols());
  const double least = std::max(0.25, 60 / count);
  Eigen::VectorXd energy = Eigen::VectorXd::Zero(found.target.rows());
  for (Index k = 0; k < found.target.cols(); ++k) {
    const std::complex<double> wave = std::exp(fit.rates[m] * (found.interval * static_cast<double>(k)));
    for (Index c = 0; c < energy.size(); ++c) energy[c] += std::pow((fit.shapes(c, m) * wave).real(), 2);
  }
  return (energy.array() > least * found.target.rowwise().squaredNorm().array()).any();
}

/// Whether a mode is at n times the frequency of another with n times its phase, or against that, in the
/// channel that shows it best: what saturates decays more slowly than the n-th power, with the same phase.
bool is_locked_to(const ModeEstimate& base, const ModeEstimate& mode, int n) {
  constexpr double off = 0.003, in_phase = 0.35, slowest = 0.25, fastest = 1.4;  // [rad], over its ratio
  Index c = 0;
  mode.pole.shape.cwiseAbs().maxCoeff(&c);
  const double phase = std::remainder(std::arg(mode.pole.shape[c]) - n * std::arg(base.pole.shape[c]),
                                      std::numbers::pi),
               f = mode.pole.frequency_hz(), ratio = mode.pole.damping_ratio() / base.pole.damping_ratio();
  return std::abs(f - n * base.pole.frequency_hz()) < off * f && std::abs(phase) < in_phase &&
         ratio > slowest && ratio < fastest;
}

/// The multiple of `base` that a mode is; 0: none.
int multiple_of(const ModeEstimate& base, const ModeEstimate& mode) {
  constexpr int most = 3;  // modes of a pinned beam are at 1, 4, 9, ...
  // An overtone shows the mode at its larger amplitudes, where frequency and damping may be others.
  constexpr double off = 0.012, damping_off = 0.4, largest = 0.5;
  const double f = mode.pole.frequency_hz(), f1 = base.pole.frequency_hz();
  const auto n = static_cast<int>(std::lround(f / f1));
  if (n < 2 || n > most || mode.strength > largest * base.strength) return 0;
  const auto deviation = [](double own, double other) {
    return std::isfinite(own) && std::isfinite(other) ? 3 * std::hypot(own, other) : 0.0;
  };
  const double ratio = mode.pole.damping_ratio(), ratio1 = base.pole.damping_ratio();
  const bool same_frequency =
      std::abs(f - n * f1) <
      std::max(off * f, deviation(mode.pole.frequency_deviation_hz, n * base.pole.frequency_deviation_hz));
  const bool same_damping =
      std::abs(ratio - ratio1) < std::max(damping_off * ratio1, deviation(mode.pole.damping_ratio_deviation,
                                                                          base.pole.damping_ratio_deviation));
  return (same_frequency && same_damping) || is_locked_to(base, mode, n) ? n : 0;
}

}  // namespace

Pole fitted_pole(const JointDecayFit& fit, std::size_t m) {
  Pole pole{fit.rates[m], fit.shapes.col(static_cast<Index>(m))};
  const auto at = static_cast<Index>(2 * m);
  pole.take_deviations(fit.covariance.block<2, 2>(at, at));
  return pole;
}

bool indistinguishable(const Pole& a, const Pole& b, double duration) {
  constexpr double cycles = 1, time_constants = 3;
  const double slower = std::min(std::abs(a.rate.real()), std::abs(b.rate.real()));
  const double length = std::min(duration, time_constants / std::max(slower, 1e-300));
  return std::abs(a.frequency_hz() - b.frequency_hz()) * length < cycles;
}

std::string objection_to(const Pole& from, const JointDecayFit& fit, std::size_t m, const RecordModes& found,
                         const StabilisationSettings& settings) {
  const Pole to = fitted_pole(fit, m);
  const double moved = std::abs(to.frequency_hz() - from.frequency_hz());
  if (!(to.damping_ratio() > 0 && moved < std::max(0.05 * from.frequency_hz(), 1 / duration_of(found))))
    return "least squares do not keep it";
  if (to.frequency_deviation_hz > settings.largest_frequency_deviation * to.frequency_hz())
    return fmt::format("too uncertain, standard deviation {:.2g} Hz", to.frequency_deviation_hz);
  if (2 * to.damping_ratio_deviation > to.damping_ratio())
    return fmt::format("too uncertain, damping ratio {:.2g} % with standard deviation {:.2g} %",
                       100 * to.damping_ratio(), 100 * to.damping_ratio_deviation);
  const double energy = energy_over_noise(fit, static_cast<Index>(m), found), noise = energy_of_noise(found);
  if (energy < noise && !dominates(fit, static_cast<Index>(m), found))
    return fmt::format("noise: energy {:.3g} times its density; less than {:.3g} is met by chance", energy,
                       noise);
  return "";
}

void set_overtones_aside(RecordModes& found) {
  std::vector<ModeEstimate> kept;
  for (const ModeEstimate& mode : found.modes) {
    const auto base = std::find_if(found.modes.begin(), found.modes.end(),
                                   [&](const ModeEstimate& one) { return multiple_of(one, mode) > 0; });
    if (base == found.modes.end()) {
      kept.push_back(mode);
      continue;
    }
    found.stabilisation.rejected.push_back(
        {mode.pole, mode.orders,
         fmt::format("overtone: {} times {:.4g} Hz with its damping ratio or its phase",
                     multiple_of(*base, mode), base->pole.frequency_hz())});
  }
  if (kept.size() < found.modes.size())
    found.objections.emplace_back(
        "overtone_mode",
        "Multiples of a mode's frequency that share its damping ratio or its phase are listed as its "
        "overtones, not as modes. Stiffness, clamp or sensor are not linear at these amplitudes.");
  found.modes = std::move(kept);
}

}  // namespace beamid::experiments
