#include "experiments/modal/frequency_step.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "experiments/modal/damped_sine_fit.hpp"
#include "experiments/modal/shape_fit.hpp"
#include "experiments/signal/decimation.hpp"
#include "experiments/signal/spectrum.hpp"
#include "experiments/signal/sway.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double stepped_window = 8, stepped_gap = 1, neighbours = 4,
                 stepped_samples_per_cycle = 8;  // periods

/// One damped sine in a window.
struct LocalSine {
  bool found = false;
  double w = 0, deviation = 0;       ///< damped angular frequency [rad/s]
  double left = 0;                   ///< sum of squares
  std::complex<double> first, last;  ///< the motion at both ends of the window
  std::complex<double> rate;
};

LocalSine sine_in(const VectorXd& samples, double interval, const ModalEstimate& mode) {
  constexpr double near = 0.25, noise = 0.3;
  const double energy = (samples.array() - samples.mean()).square().sum(), w = mode.rate().imag();
  LocalSine local;
  try {
    const double peak = 2 * std::numbers::pi * strongest_frequency(samples, interval);
    const double start = std::abs(peak / w - 1) < near ? peak : w;
    const DampedSineFit fit = fit_damped_sines(samples, interval, {{mode.rate().real(), start}});
    const DampedSine& sine = fit.sines.front();
    local.w = sine.rate.imag(), local.rate = sine.rate, local.first = sine.amplitude;
    local.last = sine.amplitude * std::exp(sine.rate * (interval * static_cast<double>(samples.size() - 1)));
    local.left = fit.residuals.squaredNorm();
    local.deviation = fit.residual_standard_deviation * std::sqrt(fit.cofactors(0, 0));
    local.found = std::abs(local.w / w - 1) < near && local.left < noise * energy;
  } catch (const std::exception&) {  // no oscillation there
  }
  return local;
}

/// What the mode and its companions, of constant frequencies from one end to the other, leave of a signal.
VectorXd left_by_modes(const DecimatedSignal& coarse, const ModalEstimate& mode) {
  std::vector<std::complex<double>> rates{mode.rate()};
  for (const CompanionMode& other : mode.companions) rates.push_back(other.rate());
  std::vector<bool> oscillating(rates.size(), true);
  rates.emplace_back(0);
  oscillating.push_back(false);
  const MatrixXd signal = coarse.samples.transpose();
  return (signal - fit_shapes(signal, coarse.interval, rates, oscillating).reconstruction).transpose();
}

/// D over what speaks against it, above 5 where the frequency steps between windows i and j; 0 elsewhere.
double step_between(const std::vector<LocalSine>& sines, Index i, Index j, Index far, double w) {
  constexpr double significant = 8, least = 0.003, still = 5, alike = 2;
  const auto of = [&](Index k) { return sines[static_cast<std::size_t>(k)]; };
  const LocalSine before = of(i), behind = of(j);
  if (!before.found || !behind.found) return 0;
  const double step = std::abs(behind.w - before.w),
               deviation = std::hypot(before.deviation, behind.deviation);
  if (step < std::max(significant * deviation, least * w)) return 0;
  double drift_before = 0, drift_behind = 0;
  for (Index k = 1; k <= far; ++k) {
    const LocalSine one = of(std::max<Index>(0, i - k)), two = of(std::min(std::ssize(sines) - 1, j + k));
    if (!one.found || !two.found) return 0;
    drift_before = std::max(drift_before, std::abs(one.w - before.w));
    drift_behind = std::max(drift_behind, std::abs(two.w - behind.w));
  }
  const bool whole = i >= far && j + far < std::ssize(sines);
  const double drift = whole ? drift_before + drift_behind : 2 * std::max(drift_before, drift_behind);
  const double grown = std::abs(behind.first) / std::abs(before.last);
  if (still * drift > step || grown > alike || grown < 1 / alike) return 0;
  return step / (drift + deviation);
}

/// The least that two damped sines leave of a signal [sum of squares], from starts of several distances and
/// dampings: a beat of modes that nobody has found.
double left_by_beat(const VectorXd& samples, double interval, const LocalSine& before,
                    const LocalSine& behind) {
  using std::abs, std::complex;
  const double w = behind.w, step = abs(behind.w - before.w);
  const auto rate = [&](double damping, double at) { return complex<double>(-damping * w, at); };
  double least = std::numeric_limits<double>::infinity();
  for (const double damping : {0.002, 0.02})
    for (const double distance : {-2.5, -1.0, 1.0, 2.5})
      for (const double from : {before.w, behind.w}) try {
          const DampedSineFit fit =
              fit_damped_sines(samples, interval, {rate(0.004, from), rate(damping, from + distance * step)});
          least = std::min(least, fit.residuals.squaredNorm());
        } catch (const std::exception&) {  // another start may do
        }
  return least;
}

/// The instant at which the motion behind, gone back along, meets that before: that of the least difference
/// [samples] behind the end of the window before.
double meeting(const LocalSine& before, const LocalSine& behind, Index apart, double interval) {
  double least = 0, best = 0;
  for (Index k = 0; k <= apart; ++k) {
    const double t = interval * static_cast<double>(k), back = interval * static_cast<double>(k - apart);
    const double difference =
        std::abs(before.last * std::exp(before.rate * t) - behind.first * std::exp(behind.rate * back));
    if (k == 0 || difference < least) least = difference, best = static_cast<double>(k);
  }
  return best;
}

}  // namespace

std::optional<FrequencyJump> frequency_step(const VectorXd& signal, double interval,
                                            const ModalEstimate& mode) {
  constexpr double explained = 4, unexplained = 3e-4;  // of the energy; a step of 0.3 % leaves 1e-3
  const double period = 1 / mode.frequency_hz;
  const int factor = decimation_factor(period / (interval * stepped_samples_per_cycle), signal.size() / 50);
  const DecimatedSignal coarse = without_sway(decimate(signal, interval, factor), period);
  const auto count = [&](double periods) {
    return std::max<Index>(1, static_cast<Index>(std::lround(periods * period / coarse.interval)));
  };
  const Index length = count(stepped_window), gap = count(stepped_gap), step = count(1);
  const Index apart = (length + 2 * gap) / step, far = static_cast<Index>(neighbours);
  if (length < 20 || coarse.samples.size() < 2 * (length + gap) + far * step) return {};
  const VectorXd left = left_by_modes(coarse, mode);
  if (left.squaredNorm() < unexplained * coarse.samples.squaredNorm()) return {};
  std::vector<LocalSine> sines;
  for (Index first = 0; first + length <= coarse.samples.size(); first += step)
    sines.push_back(sine_in(coarse.samples.segment(first, length), coarse.interval, mode));
  double clearest = 0;
  Index at = 0;
  for (Index i = 0; i + apart < std::ssize(sines); ++i) {
    const Index j = i + apart;
    const double clear = step_between(sines, i, j, far, mode.rate().imag());
    if (clear <= clearest) continue;
    const double by_steps = sines[static_cast<std::size_t>(i)].left + sines[static_cast<std::size_t>(j)].left,
                 by_modes = left.segment(i * step, length).squaredNorm() +
                            left.segment(j * step, length).squaredNorm();
    if (by_modes > explained * by_steps) clearest = clear, at = i;
  }
  if (!(clearest > 0)) return {};
  const LocalSine &before = sines[static_cast<std::size_t>(at)],
                  &behind = sines[static_cast<std::size_t>(at + apart)];
  const Index end = at * step + length - 1, span = apart * step + length;
  if (left_by_beat(coarse.samples.segment(at * step, span), coarse.interval, before, behind) <
      explained * (before.left + behind.left))
    return {};
  const double met = meeting(before, behind, apart * step - length + 1, coarse.interval);
  return FrequencyJump{coarse.start + coarse.interval * (static_cast<double>(end) + met),
                       std::abs(before.rate) / (2 * std::numbers::pi),
                       std::abs(behind.rate) / (2 * std::numbers::pi)};
}

}  // namespace beamid::experiments
