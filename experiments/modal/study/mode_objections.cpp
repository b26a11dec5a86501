#include "experiments/modal/study/mode_objections.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "experiments/modal/amplitude_dependence.hpp"
#include "experiments/modal/study/record_kind.hpp"
#include "experiments/record/inspect/defects.hpp"
#include "experiments/signal/spectrum.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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

int followed_multiple(const RecordModes& found, double frequency_hz) {
  constexpr double off = 0.05, followed = 0.9;
  if (found.modes.empty()) return 0;
  const Pole& base = found.strongest().pole;
  const auto n = static_cast<int>(std::lround(frequency_hz / base.frequency_hz()));
  if (n < 2 || n > 3 || std::abs(frequency_hz - n * base.frequency_hz()) > off * frequency_hz) return 0;
  Index channel = 0;
  base.shape.cwiseAbs().maxCoeff(&channel);
  const VectorXd signal = found.target.row(channel).transpose();
  return overtone_coherence(signal, found.interval, base.frequency_hz(), n) > followed ? n : 0;
}

void set_overtones_aside(RecordModes& found) {
  std::vector<ModeEstimate> kept;
  for (const ModeEstimate& mode : found.modes) {
    const auto base = std::find_if(found.modes.begin(), found.modes.end(),
                                   [&](const ModeEstimate& one) { return multiple_of(one, mode) > 0; });
    const int followed = followed_multiple(found, mode.pole.frequency_hz());
    if (base == found.modes.end() && followed == 0) {
      kept.push_back(mode);
      continue;
    }
    const ModeEstimate& of = followed > 0 ? found.strongest() : *base;
    found.stabilisation.rejected.push_back(
        {mode.pole, mode.orders,
         fmt::format("overtone: {} times {:.4g} Hz with its damping ratio or its phase",
                     followed > 0 ? followed : multiple_of(of, mode), of.pole.frequency_hz())});
  }
  if (kept.size() < found.modes.size())
    found.objections.emplace_back(
        "overtone_mode",
        "Multiples of a mode's frequency that share its damping ratio or its phase are listed as its "
        "overtones, not as modes. Stiffness, clamp or sensor are not linear at these amplitudes.");
  found.modes = std::move(kept);
}

namespace {

// Whether what a decay's modes leave is the same motion going on.

constexpr int resolutions_beside = 3;  // resolutions

/// Power of all channels at a frequency under a Hann window.
double windowed_power(const MatrixXd& samples, double interval, double frequency_hz) {
  const Index count = samples.cols();
  Eigen::VectorXcd wave(count);
  for (Index k = 0; k < count; ++k) {
    const double t = static_cast<double>(k), turn = 2.0 * std::numbers::pi;
    wave[k] = std::polar(0.5 - 0.5 * std::cos(turn * (t + 0.5) / static_cast<double>(count)),
                         -turn * frequency_hz * interval * t);
  }
  return (samples.cast<std::complex<double>>() * wave).squaredNorm();
}

/// Mean power about a frequency.
double power_about(const MatrixXd& samples, double interval, double frequency_hz) {
  const double step = 1.0 / (interval * static_cast<double>(samples.cols()));
  double sum = 0.0;
  for (int k = -resolutions_beside; k <= resolutions_beside; ++k)
    sum += windowed_power(samples, interval, frequency_hz + k * step);
  return sum / (2 * resolutions_beside + 1);
}

double median_power(const MatrixXd& samples, double interval, std::pair<double, double> band_hz) {
  constexpr int fewest = 20, most = 200;
  const double resolutions =
      (band_hz.second - band_hz.first) * interval * static_cast<double>(samples.cols());
  const int count = std::clamp(static_cast<int>(resolutions), fewest, most);
  std::vector<double> powers;
  for (int k = 0; k < count; ++k)
    powers.push_back(windowed_power(samples, interval,
                                    band_hz.first + (k + 0.5) / count * (band_hz.second - band_hz.first)));
  return median(powers);
}

double motion_size_of(const MatrixXd& samples) {
  return (samples.colwise() - samples.rowwise().mean()).norm();
}

/// Whether the motion of some periods is larger than that of some before.
bool motion_rises(const MatrixXd& motion, Index part) {
  constexpr double larger = 1.2;
  if (part < 4) return true;
  double least = motion_size_of(motion.leftCols(std::min(part, motion.cols())));
  for (Index at = part; at + part <= motion.cols(); at += part) {
    const double size = motion_size_of(motion.middleCols(at, part));
    if (size > larger * least) return true;
    least = std::min(least, size);
  }
  return false;
}

Index samples_in_periods(double periods, const ModeEstimate& mode, double interval) {
  return static_cast<Index>(periods / (mode.pole.frequency_hz() * interval));
}

/// Modes of a free decay leave noise, or motion that dies out with them. Under loads that go on they leave
/// motion at their own frequencies to the end, and it rises at times: 15 % of the motion; some four periods
/// are 1.2 times as large as four before; and at a mode, in the second half of `target` - `reproduced`, the
/// power within three resolutions is 10 times the band's median (of white noise with probability 1e-13), and
/// a quarter of the first half's.
bool motion_goes_on(const RecordModes& found) {
  constexpr double least_left = 0.15, above_median = 10.0, as_early = 0.25;
  const MatrixXd left = found.target - found.reproduced;
  const MatrixXd motion = found.target.colwise() - found.target.rowwise().mean();
  if (left.norm() < least_left * motion.norm() ||
      !motion_rises(motion, samples_in_periods(4.0, found.strongest(), found.interval)))
    return false;
  const MatrixXd early = left.leftCols(left.cols() / 2), late = left.rightCols(left.cols() / 2);
  const double usual = median_power(late, found.interval, found.band_hz);
  return std::any_of(found.modes.begin(), found.modes.end(), [&](const ModeEstimate& mode) {
    const double f = mode.pole.frequency_hz(), power = power_about(late, found.interval, f);
    return power > above_median * usual && power > as_early * power_about(early, found.interval, f);
  });
}

// Whether the record before the window is what a free decay has before it.

/// Without a straight line in each channel: what is pulled slowly does not vibrate.
double swing_size_of(MatrixXd samples) {
  samples.colwise() -= samples.rowwise().mean().eval();
  const VectorXd line = VectorXd::LinSpaced(samples.cols(), -1.0, 1.0).normalized();
  samples -= (samples * line).eval() * line.transpose();
  return samples.norm();
}

/// Motion of a part of the record before the window, and what remains of it without the modes taken back.
struct PartBefore {
  double motion = 0.0, residual = 0.0;
};

PartBefore part_before(const Record& whole, const RecordModes& found, Index from, Index count) {
  MatrixXd part = whole.samples.middleCols(from, count);
  const double motion = swing_size_of(part);
  for (const ModeEstimate& mode : found.modes)
    for (Index k = 0; k < count; ++k) {
      const double t = whole.time[from + k] - found.start;
      part.col(k) -= (mode.pole.shape * std::exp(mode.pole.rate * t)).real();
    }
  return {motion, swing_size_of(part)};
}

/// Whether nothing was released where the decay begins. Before a hit or a release the structure rests, or
/// moves less; a window that begins later holds the same decay before it. So, back from the window in parts
/// of two periods of the strongest mode: while the modes taken back explain half of a part, it belongs to
/// the decay, over one time constant at most. Of the motion behind them, the next two parts have 0.6, or 0.5
/// and 0.3, only where the motion comes to its largest and goes; a single one 0.8.
bool moved_before(const Record& whole, const RecordModes& found) {
  constexpr double as_much = 0.6, explained = 0.5, alone = 0.8;
  constexpr std::pair falling{0.5, 0.3};
  if (found.modes.empty()) return false;
  const ModeEstimate& strongest = found.strongest();
  const Index begin =
      std::lower_bound(whole.time.begin(), whole.time.end(), found.record.time[0]) - whole.time.begin();
  const Index part = std::min(found.record.size(), samples_in_periods(2.0, strongest, whole.interval()));
  if (part < 4) return false;
  const auto slow = static_cast<Index>(1.0 / (-strongest.pole.rate.real() * whole.interval()));
  double behind = swing_size_of(whole.samples.middleCols(begin, std::min(part, whole.size() - begin)));
  Index at = begin;
  for (; at >= part && begin - at < slow; at -= part) {
    const PartBefore before = part_before(whole, found, at - part, part);
    if (before.residual > explained * before.motion) break;
    behind = before.motion;
  }
  if (at < part || has_hits(whole)) return false;  // hits rise above what moved before
  const double first = swing_size_of(whole.samples.middleCols(at - part, part)) / behind;
  if (at < 2 * part) return first > alone;
  const double second = swing_size_of(whole.samples.middleCols(at - 2 * part, part)) / behind;
  return (first > as_much && second > as_much) ||
         (first > falling.first && second > falling.second && second < first);
}

/// Powers of the lines from one frequency to another, of all channels (padded with zeros).
VectorXd line_powers(const MatrixXd& samples, double interval, double from_hz, double to_hz) {
  const double step = 1.0 / (interval * static_cast<double>(samples.cols()));
  const auto first = std::max<Index>(1, static_cast<Index>(std::lround(from_hz / step))),
             last = std::min<Index>(samples.cols() / 2, static_cast<Index>(std::lround(to_hz / step)));
  if (last < first) return VectorXd::Zero(0);
  return lines_between(samples.transpose(), first, last - first + 1).cwiseAbs2().colwise().sum().transpose();
}

}  // namespace

ResidualAtMode residual_at(const RecordModes& found, const ModeEstimate& mode) {
  constexpr double beside = 0.15, time_constants = 3.0;
  const auto lasting = static_cast<Index>(time_constants / (-mode.pole.rate.real() * found.interval));
  const Index count =
      std::clamp<Index>(lasting, std::min<Index>(16, found.target.cols()), found.target.cols());
  const double f = mode.pole.frequency_hz(),
               reach = std::max(beside * f, 3.0 / (found.interval * static_cast<double>(count)));
  const MatrixXd target = found.target.leftCols(count), motion = target.colwise() - target.rowwise().mean(),
                 left = target - found.reproduced.leftCols(count);
  const VectorXd of_motion = line_powers(motion, found.interval, f - reach, f + reach),
                 of_left = line_powers(left, found.interval, f - reach, f + reach);
  double white = 0.0;
  for (Index c = 0; c < found.record.samples.rows(); ++c)
    white += std::pow(noise_floor(found.record.samples.row(c).transpose()), 2);
  white *= static_cast<double>(count) * found.record.interval() / found.interval;
  return {std::sqrt(of_left.sum() / of_motion.sum()),
          of_left.sum() / std::max(white * static_cast<double>(of_left.size()), 1e-300)};
}

void object_to_decay(const Record& whole, RecordModes& found) {
  constexpr double least_loss = 0.05, most_left = 0.2;
  constexpr double mostly = 0.3, late_share = 0.1;  // of the motion's size; of the first half's energy
  if (found.modes.empty() || found.reproduced.size() == 0) return;
  const double f = found.strongest().pole.frequency_hz();
  const MatrixXd motion = found.target.colwise() - found.target.rowwise().mean();
  const Index half = motion.cols() / 2;
  const double left = (found.target - found.reproduced).norm() / motion.norm();
  const bool dies = left < mostly &&
                    motion.rightCols(half).squaredNorm() < late_share * motion.leftCols(half).squaredNorm();
  const std::string advice =
      std::string(dies ? "Standard deviations are too small."
                       : "Frequencies, damping ratios and their standard deviations are "
                         "not reliable.") +
      " For random vibration take --method ssi_cov or bayoma and a record of many decay "
      "times; for a decay, a --window of it alone.";
  const auto object = [&](const char* kind, const std::string& text, double statistic = std::nan(""),
                          double limit = std::nan("")) {
    found.objections.emplace_back(kind, text, statistic, limit);
    found.decays = false;
  };
  if (const double loss = 1.0 - std::exp(found.strongest().pole.rate.real() * duration_of(found));
      loss < least_loss) {
    object("no_decay",
           fmt::format(
               "The record does not decay: its motion at {:.4g} Hz loses {:.2g} % over the whole record. A "
               "steady sine, as of a machine or the mains, has no damping ratio. Record a release, a hit "
               "or random vibration with the machine at rest, or exclude the line with --band.",
               f, 100.0 * std::max(loss, 0.0)),
           loss, least_loss);
    return;
  }
  if (moved_before(whole, found)) {
    object(
        "no_decay",
        fmt::format("No release was found: the record moves as much before its largest reading, at {:.4g} s, "
                    "as after. {}",
                    found.record.time[0], advice));
    return;
  }
  found.at_strongest = residual_at(found, found.strongest());
  if (motion_goes_on(found))
    object(
        "no_decay",
        fmt::format("The motion goes on: the modes do not explain {:.2g} % of it, at their own frequencies "
                    "and to the end, which no decay does. {}",
                    100.0 * left, advice));
  else if (found.at_strongest.exceeds(most_left))
    object(
        "unexplained_motion",
        fmt::format("The modes do not explain {:.2g} % of the motion about {:.4g} Hz, {:.3g} times the noise "
                    "there: frequency or damping ratio follow the amplitude, a mode nearby was missed, or "
                    "something still moves the structure. {}",
                    100.0 * found.at_strongest.share, f, std::sqrt(found.at_strongest.over_noise), advice),
        found.at_strongest.share, most_left);
  // What dies out and decaying modes reproduce for the most part is a decay, whatever goes on beside it.
  found.decays = found.decays || dies;
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
