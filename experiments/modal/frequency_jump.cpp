#include "experiments/modal/frequency_jump.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "experiments/modal/dominant_mode.hpp"
#include "experiments/signal/decimation.hpp"

namespace beamid::experiments {
namespace {

using Eigen::ArrayXd, Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double turn = 2 * std::numbers::pi, window_periods = 8, gap_periods = 1, still_periods = 4,
                 steps_per_period = 1;
constexpr double sampled_per_cycle = 16, widest_ratio = 4.6, grid = 0.015;  // of the logarithm of frequency

/// The signal in windows that begin a period after one another.
struct Windows {
  DecimatedSignal signal;
  Index length = 0, step = 0, gap = 0;  ///< [samples]
  VectorXd peaks;                       ///< the strongest frequency of each [Hz]

  VectorXd samples(Index i) const { return signal.samples.segment(i * step, length); }
  /// Of the samples of a window from the instant that is a gap before it [s].
  VectorXd times_behind() const {
    return signal.interval *
           VectorXd::LinSpaced(length, static_cast<double>(gap), static_cast<double>(gap + length - 1));
  }
  Index in(double periods) const { return static_cast<Index>(periods * steps_per_period); }
  /// Windows from the one that ends at an instant to the one that begins there.
  Index apart() const {
    return static_cast<Index>(std::lround(static_cast<double>(length + 2 * gap) / static_cast<double>(step)));
  }
};

MatrixXd parabolas(const VectorXd& time) {
  MatrixXd basis(time.size(), 3);
  basis << VectorXd::Ones(time.size()), time, time.cwiseAbs2();
  return basis;
}

VectorXd strongest_frequencies(const Windows& windows, double around_hz) {
  const double interval = windows.signal.interval,
               highest = std::min(widest_ratio * around_hz, 0.42 / interval);
  const VectorXd time =
      VectorXd::LinSpaced(windows.length, -0.5, 0.5) * (interval * static_cast<double>(windows.length - 1));
  const ArrayXd taper =
      1 + (time.array() * (turn / (interval * static_cast<double>(windows.length + 1)))).cos();
  std::vector<double> hz;
  for (double f = around_hz / widest_ratio; f < highest; f *= std::exp(grid)) hz.push_back(f);
  const auto count = static_cast<Index>(hz.size());
  MatrixXd waves(windows.length, 2 * count);
  for (Index i = 0; i < count; ++i) {
    const ArrayXd phase = turn * hz[static_cast<std::size_t>(i)] * time.array();
    waves.col(i) = phase.cos() * taper;
    waves.col(count + i) = phase.sin() * taper;
  }
  const Eigen::HouseholderQR<MatrixXd> trend(parabolas(time));
  const MatrixXd smooth = trend.householderQ() * MatrixXd::Identity(windows.length, 3);
  const Index many = (windows.signal.samples.size() - windows.length) / windows.step + 1;
  VectorXd peaks(many);
  for (Index i = 0; i < many; ++i) {
    VectorXd samples = windows.samples(i);
    samples -= smooth * (smooth.transpose() * samples);
    const VectorXd lines = waves.transpose() * samples;
    Index peak = 0;
    (lines.head(count).array().square() + lines.tail(count).array().square()).maxCoeff(&peak);
    peaks[i] = hz[static_cast<std::size_t>(peak)];
  }
  return peaks;
}

/// What a window holds of two oscillations, at the instant beside it.
struct Shares {
  double own = 0, other = 0;  ///< amplitudes
  double deviation = 0;       ///< of an amplitude
  double left = 0;            ///< of the energy beside the mean
};

Shares shares_in(const VectorXd& samples, const VectorXd& time, double own_hz, double other_hz,
                 double damping) {
  MatrixXd basis(time.size(), 7);
  basis.leftCols(3) = parabolas(time);
  Index column = 3;
  for (const double hz : {own_hz, other_hz}) {
    const ArrayXd envelope = (-damping * turn * hz * time.array()).exp(), phase = turn * hz * time.array();
    basis.col(column++) = envelope * phase.cos();
    basis.col(column++) = envelope * phase.sin();
  }
  const Eigen::HouseholderQR<MatrixXd> factors(basis);
  const VectorXd x = factors.solve(samples);
  const double squares = (samples - basis * x).squaredNorm();
  const MatrixXd inverse =
      MatrixXd(factors.matrixQR().topRows(7).triangularView<Eigen::Upper>()).inverse().bottomRows(4);
  const double largest = inverse.rowwise().norm().maxCoeff();
  return {std::hypot(x[3], x[4]), std::hypot(x[5], x[6]),
          largest * std::sqrt(squares / static_cast<double>(samples.size() - 7)),
          squares / (samples.array() - samples.mean()).square().sum()};
}

/// The oscillation near a frequency in a window; the peak itself where no least squares converge.
DampedSineFit refined(const VectorXd& samples, double interval, double hz, double damping) {
  constexpr double near = 0.1;  // a window of two cycles shifts its peak by so much
  const std::complex<double> rate = turn * hz * std::complex<double>(-damping, 1);
  try {
    DampedSineFit fit = fit_damped_sines(samples, interval, {rate});
    if (std::abs(fit.sines.front().rate.imag() / rate.imag() - 1) < near) return fit;
  } catch (const std::exception&) {
  }
  DampedSineFit fit;
  fit.sines = {{rate, {}}};
  return fit;
}

/// The damping ratio of a window's oscillation: of the whole record it may be what a jump makes of it.
double own_damping(const Windows& windows, Index i, double damping) {
  const std::complex<double> rate =
      refined(windows.samples(i), windows.signal.interval, windows.peaks[i], damping).sines.front().rate;
  return std::max(0.0, -rate.real() / std::abs(rate));
}

/// The energy that is left on both sides where the frequency jumps between windows i and j; nothing where it
/// does not.
std::optional<double> left_by_jump(const Windows& windows, Index i, Index j, double damping) {
  constexpr double least = 0.18, still = 0.2, absent = 0.3, alike = 2, significant = 8, noise = 0.2;
  const auto log_ratio = [&](Index from, Index to) {
    return std::log(windows.peaks[to] / windows.peaks[from]);
  };
  const double jump = std::abs(log_ratio(i, j));
  if (jump < least) return {};
  const Index far = windows.in(still_periods), last = windows.peaks.size() - 1;
  double drift =
      std::abs(log_ratio(std::max<Index>(0, i - far), i)) + std::abs(log_ratio(j, std::min(last, j + far)));
  if (i < far || j + far > last) drift *= 2;  // one side stands for both
  if (drift > still * jump) return {};
  const VectorXd behind = windows.times_behind(), before = -behind.reverse();
  const double one = windows.peaks[i], two = windows.peaks[j],
               least_damping = std::min(own_damping(windows, i, damping), own_damping(windows, j, damping));
  const Shares b = shares_in(windows.samples(i), before, one, two, least_damping),
               a = shares_in(windows.samples(j), behind, two, one, least_damping);
  const double grown = a.own / b.own;
  if (!(b.other < absent * b.own && a.other < absent * a.own && grown < alike && grown > 1 / alike &&
        b.own > significant * b.deviation && a.own > significant * a.deviation && b.left < noise &&
        a.left < noise))
    return {};
  return b.left + a.left;
}

/// The sample from which on the motion behind, gone back along, is nearer to the signal than that before.
Index turning_point(const Windows& windows, Index i, Index j, const DampedSineFit& before,
                    const DampedSineFit& behind) {
  const Index first = i * windows.step, count = (j - i) * windows.step + windows.length;
  const auto left = [&](const DampedSineFit& fit, Index begin, Index k) {
    const double t = windows.signal.interval * static_cast<double>(k - begin);
    const DampedSine& sine = fit.sines.front();
    return windows.signal.samples[k] - fit.offset - (sine.amplitude * std::exp(sine.rate * t)).real();
  };
  double sum = 0, least = 0;
  Index best = first;
  for (Index k = first; k < first + count; ++k) {
    sum += std::pow(left(before, first, k), 2) - std::pow(left(behind, j * windows.step, k), 2);
    if (sum < least) least = sum, best = k + 1;
  }
  return best;
}

}  // namespace

std::string FrequencyJump::words() const {
  return fmt::format("the frequency jumps from {:.4g} to {:.4g} Hz, {:.4g} times, while the motion goes on",
                     before_hz, behind_hz, ratio());
}

std::optional<FrequencyJump> frequency_jump(const VectorXd& signal, double interval,
                                            const ModalEstimate& mode) {
  const double period = 1 / mode.frequency_hz;
  Windows windows;
  windows.signal = decimate(signal, interval,
                            decimation_factor(period / (interval * sampled_per_cycle), signal.size() / 50));
  const auto count = [&](double periods) {
    return std::max<Index>(1, static_cast<Index>(std::lround(periods * period / windows.signal.interval)));
  };
  windows.length = count(window_periods), windows.gap = count(gap_periods),
  windows.step = count(1 / steps_per_period);
  constexpr Index unknowns = 7;
  if (windows.length < 3 * unknowns || windows.signal.samples.size() < 2 * (windows.length + windows.gap))
    return {};
  windows.peaks = strongest_frequencies(windows, mode.frequency_hz);
  std::optional<double> least;
  Index clearest = 0;
  for (Index i = 0; i + windows.apart() < windows.peaks.size(); ++i) {
    const auto left = left_by_jump(windows, i, i + windows.apart(), mode.damping_ratio);
    if (left && (!least || *left < *least)) least = left, clearest = i;
  }
  if (!least) return {};
  const Index behind = clearest + windows.apart();
  const auto fit = [&](Index i) {
    return refined(windows.samples(i), windows.signal.interval, windows.peaks[i], mode.damping_ratio);
  };
  const DampedSineFit one = fit(clearest), two = fit(behind);
  const Index at = turning_point(windows, clearest, behind, one, two);
  return FrequencyJump{windows.signal.start + windows.signal.interval * static_cast<double>(at),
                       std::abs(one.sines.front().rate) / turn, std::abs(two.sines.front().rate) / turn};
}

}  // namespace beamid::experiments
