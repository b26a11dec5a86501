#include "experiments/modal/decay_jump.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Core>
#include <Eigen/Dense>

#include "experiments/modal/dominant_mode.hpp"
#include "experiments/modal/frequency_jump.hpp"
#include "experiments/modal/subspace_realisation.hpp"
#include "experiments/signal/decimation.hpp"
#include "experiments/signal/spectrum.hpp"
#include "experiments/signal/sway.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

// Whether the frequency of a free decay changes at one instant by a few per cent: something came loose.

/// The clearest step of the frequency of a decay (N, finite), by 0.3 to 18 %, where there is one. A damped
/// sine is fitted to every eight periods of the signal, decimated to eight samples per cycle and freed of
/// what sways below the mode. Between two such windows, two periods apart, the frequency steps where the
/// difference D
///
/// - is eight of its deviations and 0.3 % of the frequency,
/// - is five times what the frequencies of neighbours, one to four periods further away, differ by: where a
///   frequency follows the amplitude, or two modes beat, it changes there, too,
/// - and both fits leave less than a quarter of what the mode and its companions, of constant frequencies
///   over the whole record, leave there: beats that the modal analysis has found are no step; nor do two
///   damped sines fitted to both windows and what lies between them: beats that it has not found.
std::optional<FrequencyJump> frequency_step(const Eigen::VectorXd& signal, double interval,
                                            const ModalEstimate& mode);

using Eigen::ArrayXd, Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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

using Complex = std::complex<double>;

constexpr double jump_samples_per_cycle = 8, window = 12, left_out = 1, fewest = 4;  // periods
constexpr Index kernel_and_more = 50;

/// Re and -Im of e^(rate t) times a shape: coefficients are those of a complex amplitude.
void append(MatrixXd& basis, Index& column, Complex rate, const VectorXd& time, const ArrayXd& shape) {
  const Eigen::ArrayXcd motion = (rate * time.cast<Complex>()).array().exp();
  basis.col(column++) = motion.real() * shape;
  basis.col(column++) = -motion.imag() * shape;
}

/// What is known of the signal at one instant.
struct Instant {
  double time = 0;       ///< [s], from the first sample
  double step = 0;       ///< F of the step, beside nothing
  double beyond = 0;     ///< F of the step, beside the next power of time
  double left = 0;       ///< variance that the step leaves
  Complex before, jump;  ///< amplitudes
};

/// The three motions fitted about an instant, `before` and `behind` samples of it away and more.
class Motions {
 public:
  Motions(Index before, Index behind, Index gap, double interval, const ModalEstimate& mode, int degree)
      : before_(before), behind_(behind) {
    VectorXd time(before + behind);
    time << VectorXd::LinSpaced(before, static_cast<double>(-gap - before + 1), static_cast<double>(-gap)),
        VectorXd::LinSpaced(behind, static_cast<double>(gap), static_cast<double>(gap + behind - 1));
    time *= interval;
    const ArrayXd u = time.array() * mode.frequency_hz / (window + left_out);
    const auto companions = static_cast<Index>(mode.companions.size());
    columns_ = 1 + 2 * (degree + 1) + 2 * companions;
    MatrixXd basis(time.size(), columns_ + 2);
    Index column = 0;
    for (int power = 0; power <= degree; ++power) append(basis, column, mode.rate(), time, u.pow(power));
    basis.col(column++).setOnes();
    for (const CompanionMode& other : mode.companions)
      append(basis, column, other.rate(), time, ArrayXd::Ones(u.size()));
    append(basis, column, mode.rate(), time, u.pow(degree + 1));
    smoother_.compute(basis);
    column = columns_;
    append(basis, column, mode.rate(), time, (u > 0).cast<double>());
    stepped_.compute(basis);
  }

  bool are_of(Index before, Index behind) const { return before == before_ && behind == behind_; }
  bool are_few() const { return before_ + behind_ < 2 * (columns_ + 2); }

  // Of A = Q R, Q^T y behind the first columns is what they leave: the smooth motion's are the step's first.
  Instant seen_in(const VectorXd& samples) const {
    const Index free = samples.size() - columns_ - 2;
    const VectorXd turned = stepped_.householderQ().transpose() * samples,
                   smoother = smoother_.householderQ().transpose() * samples;
    const double squares = turned.tail(free).squaredNorm(), variance = squares / static_cast<double>(free);
    const VectorXd x = stepped_.matrixQR()
                           .topRows(columns_ + 2)
                           .triangularView<Eigen::Upper>()
                           .solve(turned.head(columns_ + 2));
    return {0,
            turned.segment(columns_, 2).squaredNorm() / 2 / variance,
            (smoother.tail(free).squaredNorm() - squares) / 2 / variance,
            variance,
            {x[0], x[1]},
            {x[columns_], x[columns_ + 1]}};
  }

 private:
  Index before_, behind_, columns_ = 0;
  Eigen::HouseholderQR<MatrixXd> smoother_, stepped_;  // with the next power of time, with the step
};

std::vector<Instant> instants_of(const DecimatedSignal& coarse, const ModalEstimate& mode, int degree) {
  const double samples = 1 / (mode.frequency_hz * coarse.interval);  // per period
  const auto count = [&](double periods) {
    return std::max<Index>(1, static_cast<Index>(std::lround(periods * samples)));
  };
  const Index gap = count(left_out), most = count(window), least = count(fewest),
              size = coarse.samples.size();
  std::vector<Instant> instants;
  std::optional<Motions> motions;
  for (Index at = gap + least; at + gap + least <= size; at += count(0.5)) {
    const Index before = std::min(most, at - gap + 1), behind = std::min(most, size - at - gap);
    if (!motions || !motions->are_of(before, behind))
      motions.emplace(before, behind, gap, coarse.interval, mode, degree);
    if (motions->are_few()) continue;
    VectorXd around(before + behind);
    around << coarse.samples.segment(at - gap - before + 1, before), coarse.samples.segment(at + gap, behind);
    instants.push_back(motions->seen_in(around));
    instants.back().time = coarse.start + coarse.interval * static_cast<double>(at);
  }
  return instants;
}

template <class Of>
double median_of(const std::vector<Instant>& instants, Of of) {
  std::vector<double> values;
  for (const Instant& one : instants) values.push_back(of(one));
  return median(std::move(values));
}

/// Nothing where none is a jump.
const Instant* clearest_of(const std::vector<Instant>& instants, double amplitude) {
  constexpr double surely = 15, above_others = 8, above_a_walk = 25;
  constexpr double as_good = 2, smallest = 0.003, least_amplitude = 0.1;
  if (instants.empty()) return nullptr;
  const double usual = std::max(1.0, median_of(instants, [](const Instant&i) { return i.step; })),
               left = median_of(instants, [](const Instant&i) { return i.left; }),
               needed = std::max({surely, above_others * usual, above_a_walk * (usual - 1.0)});
  const Instant* clearest = nullptr;
  for (const Instant& i : instants)
    if (i.beyond > needed && i.left < as_good * left && std::abs(i.jump) > smallest * std::abs(i.before) &&
        std::max(std::abs(i.before), std::abs(i.before + i.jump)) > least_amplitude * amplitude &&
        (!clearest || i.beyond > clearest->beyond))
      clearest = &i;
  return clearest;
}

DecayJump jump_at(const Instant& instant) {
  const Complex ratio = 1.0 + instant.jump / instant.before;
  return {MotionJump{instant.time, std::abs(ratio), std::arg(ratio)}};
}

}  // namespace

std::string MotionJump::words() const {
  return fmt::format("the motion jumps, by {:+.2g} % in amplitude and {:+.2g} degrees in phase",
                     100 * (amplitude_ratio - 1), phase * 180 / std::numbers::pi);
}

double DecayJump::time() const {
  return std::visit([](const auto& jump) { return jump.time; }, kind);
}

const FrequencyJump* DecayJump::frequency() const {
  return std::get_if<FrequencyJump>(&kind);
}

const MotionJump* DecayJump::motion() const {
  return std::get_if<MotionJump>(&kind);
}

std::string DecayJump::words() const {
  return std::visit([](const auto& jump) { return jump.words(); }, kind);
}

std::string DecayJump::sentence(double begin) const {
  return fmt::format("At {:.4g} s {}: {}.", begin + time(), words(),
                     frequency() ? "the sampling rate changed there, or the structure did"
                                 : "something touched the structure, or samples were lost");
}

std::optional<DecayJump> decay_jump(const VectorXd& signal, double interval, const ModalEstimate& mode) {
  if (const auto jump = frequency_jump(signal, interval, mode)) return DecayJump{*jump};
  if (const auto step = frequency_step(signal, interval, mode)) return DecayJump{*step};
  const int factor = decimation_factor(1 / (mode.frequency_hz * interval * jump_samples_per_cycle),
                                       signal.size() / kernel_and_more);
  const DecimatedSignal coarse = without_sway(decimate(signal, interval, factor), 1 / mode.frequency_hz);
  constexpr double confirmed = 5;
  const std::vector<Instant> smooth = instants_of(coarse, mode, 3);
  if (const Instant* found = clearest_of(smooth, mode.amplitude)) return jump_at(*found);
  const std::vector<Instant> straight = instants_of(coarse, mode, 1);
  const Instant* found = clearest_of(straight, mode.amplitude);
  if (found && std::any_of(smooth.begin(), smooth.end(), [&](const Instant& one) {
        return std::abs(one.time - found->time) * mode.frequency_hz < 1 && one.beyond > confirmed;
      }))
    return jump_at(*found);
  return {};
}

}  // namespace beamid::experiments
