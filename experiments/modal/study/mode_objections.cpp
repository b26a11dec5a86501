#include "experiments/modal/study/mode_objections.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

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
  const Eigen::VectorXcd wave = decaying_wave(fit.rates[m], found.interval, found.target.cols());
  for (Index c = 0; c < fit.shapes.rows(); ++c)
    energy += (fit.shapes(c, m) * wave).real().squaredNorm() / std::max(fit.noise_variance(c, m), 1e-300);
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
  Eigen::VectorXd energy(found.target.rows());
  const Eigen::VectorXcd wave = decaying_wave(fit.rates[m], found.interval, found.target.cols());
  for (Index c = 0; c < energy.size(); ++c) energy[c] = (fit.shapes(c, m) * wave).real().squaredNorm();
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

namespace {

MergedValue merged(const std::vector<double>& values, const std::vector<double>& deviations) {
  const auto count = static_cast<double>(values.size());
  const bool known = std::all_of(deviations.begin(), deviations.end(), [](double d) { return d > 0; });
  double weight = 0, sum = 0, square = 0, chi_square = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double w = known ? 1 / (deviations[i] * deviations[i]) : 1;
    weight += w;
    sum += w * values[i];
  }
  MergedValue result;
  result.mean = sum / weight;
  for (const double value : values) square += std::pow(value - result.mean, 2);
  result.deviation = known ? std::sqrt(1 / weight) : Pole::unknown;
  result.scatter = count > 1 ? std::sqrt(square / (count * (count - 1))) : Pole::unknown;
  if (known && count > 1) {
    for (std::size_t i = 0; i < values.size(); ++i)
      chi_square += std::pow((values[i] - result.mean) / deviations[i], 2);
    result.scattered = chi_square > chi_square_limit(count - 1);
  }
  return result;
}

bool same(const Pole& a, const Pole& b) {
  return std::abs(a.frequency_hz() - b.frequency_hz()) < 0.05 * a.frequency_hz() &&
         modal_assurance(a.shape, b.shape) >= 0.8;
}

}  // namespace

int MergedMode::records() const {
  return static_cast<int>(std::count_if(places.begin(), places.end(), [](int at) { return at >= 0; }));
}

std::vector<MergedMode> merge_modes(const std::vector<RecordModes>& records) {
  std::vector<MergedMode> merged_modes;
  std::vector<Pole> first;  // of each merged mode, where it was met first
  for (std::size_t r = 0; r < records.size(); ++r)
    for (std::size_t m = 0; m < records[r].modes.size(); ++m) {
      const Pole& pole = records[r].modes[m].pole;
      std::size_t best = merged_modes.size();
      for (std::size_t k = 0; k < merged_modes.size(); ++k)
        if (merged_modes[k].places[r] < 0 && same(first[k], pole) &&
            (best == merged_modes.size() ||
             std::abs(first[k].rate - pole.rate) < std::abs(first[best].rate - pole.rate)))
          best = k;
      if (best == merged_modes.size()) {
        merged_modes.push_back({std::vector<int>(records.size(), -1), {}, {}});
        first.push_back(pole);
      }
      merged_modes[best].places[r] = static_cast<int>(m);
    }
  for (MergedMode& mode : merged_modes) {
    std::vector<double> frequency, frequency_deviation, damping, damping_deviation;
    for (std::size_t r = 0; r < records.size(); ++r) {
      if (mode.places[r] < 0) continue;
      const Pole& pole = records[r].modes[mode.places[r]].pole;
      frequency.push_back(pole.frequency_hz());
      frequency_deviation.push_back(pole.frequency_deviation_hz);
      damping.push_back(pole.damping_ratio());
      damping_deviation.push_back(pole.damping_ratio_deviation);
    }
    mode.frequency_hz = merged(frequency, frequency_deviation);
    mode.damping_ratio = merged(damping, damping_deviation);
  }
  std::sort(merged_modes.begin(), merged_modes.end(), [](const MergedMode& a, const MergedMode& b) {
    return a.frequency_hz.mean < b.frequency_hz.mean;
  });
  return merged_modes;
}

}  // namespace beamid::experiments
