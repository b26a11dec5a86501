#include "experiments/identify/backbone/sine_windows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::VectorXd;
using std::numbers::pi;

std::optional<SineWindow> sine_window(const DecimatedSignal& coarse, Index begin, Index count,
                                      const std::vector<Complex>& starts) {
  std::optional<SineWindow> best;
  const VectorXd part = coarse.samples.segment(begin, count);
  for (const Complex start : starts) {
    try {
      const DampedSineFit fit = fit_damped_sines(part, coarse.interval, {start});
      const Complex s = fit.sines[0].rate;
      const double squares = fit.residuals.squaredNorm();
      if (!(s.imag() > 0) || s.imag() * coarse.interval > 0.9 * pi || !(squares >= 0)) continue;
      if (best && !(squares < best->squares)) continue;
      best = SineWindow{begin, count, fit.sines[0], fit.offset, squares, static_cast<double>(count) - 5};
    } catch (const std::exception&) {  // of several starts one at least converges, or there is no window
    }
  }
  return best;
}

std::vector<Complex> around(double w, double damping_rate) {
  std::vector<Complex> starts;
  for (const double factor : {1.0, 1.04, 0.97, 1.1, 1.2, 0.9, 0.75, 1.35, 0.6})
    starts.emplace_back(-damping_rate, factor * w);
  return starts;
}

class SineWindowWalk {
 public:
  SineWindowWalk(const DecimatedSignal& coarse, double frequency_hz, double power,
                 const WindowSettings& settings)
      : coarse_(coarse), power_(power), settings_(settings), w_(2 * pi * frequency_hz) {}

  const std::string& ended() const { return ended_; }

  /// Nothing where the walk has ended.
  std::optional<SineWindow> next() {
    const Index least = fewest_samples();
    if (begin_ + least > all()) return end("the record ends");
    std::optional<SineWindow> window = sine_window(coarse_, begin_, least, around(w_, damping_rate_));
    if (!window) return end("no damped sine fits what follows");
    w_ = window->mode.rate.imag();
    if (!lengthen(*window, speed_up(*window))) return end("the record ends");
    const double left = window->left(),
                 middle = std::abs(window->mode.amplitude) *
                          std::exp(window->mode.rate.real() * coarse_.interval * 0.5 * double(window->count));
    least_left_ = std::min(least_left_, left);
    constexpr double over_least = 3, over_own = 1.5;  // its own holds harmonics and other modes
    if (middle < over_least * least_left_ && begin_ > 0) return end("the motion is lost in the noise");
    if (middle < over_own * left) return end("no damped sine fits what follows");
    w_ = window->mode.rate.imag();
    damping_rate_ = std::max(-window->mode.rate.real(), 1e-4 * w_);
    begin_ += window->count;
    return window;
  }

 private:
  Index all() const { return coarse_.samples.size(); }
  Index fewest_samples() const {
    const double cycles = settings_.fewest_cycles;
    return std::max<Index>(static_cast<Index>(std::ceil(cycles * 2 * pi / (w_ * coarse_.interval))), 14);
  }
  std::nullopt_t end(const char* why) {
    ended_ = why;
    return std::nullopt;
  }

  /// A velocity's amplitude falls with omega A, an acceleration's with omega^2 A: that of the displacement
  /// faster, where the next cycles are faster. By this rate [1/s].
  double speed_up(const SineWindow& window) const {
    if (!(power_ > 0) || begin_ + 2 * window.count > all()) return 0;
    const auto next = sine_window(coarse_, begin_ + window.count, window.count, around(w_, damping_rate_));
    if (!next) return 0;
    return power_ * std::log(std::abs(next->mode.rate) / std::abs(window.mode.rate)) /
           (coarse_.interval * static_cast<double>(window.count));
  }

  /// As long as the amplitude takes, which a short window shows badly; false where the record is shorter.
  bool lengthen(SineWindow& window, double faster) {
    for (int round = 0; round < 3; ++round) {
      const double rate = std::max(-window.mode.rate.real(), 0.0) + std::max(faster, 0.0),
                   fall = -std::log(settings_.amplitude_ratio) / std::max(rate, 1e-6 * w_);
      w_ = window.mode.rate.imag();
      const Index fewest = fewest_samples(),
                  wanted = std::max(fewest, static_cast<Index>(std::min(fall / coarse_.interval, 1e9)));
      if (begin_ + fewest > all()) return false;
      const Index count = std::min(wanted, all() - begin_);
      if (count == window.count) return true;
      const auto other = sine_window(coarse_, begin_, count, {window.mode.rate});
      if (!other) return true;
      window = *other;
    }
    return true;
  }

  const DecimatedSignal& coarse_;
  double power_;
  const WindowSettings& settings_;
  double w_, damping_rate_ = 0.01 * w_, least_left_ = std::numeric_limits<double>::infinity();
  Index begin_ = 0;
  std::string ended_;
};

}  // namespace

double SineWindow::left() const {
  return std::sqrt(squares / freedom);
}

SineWindows sine_windows(const DecimatedSignal& coarse, double frequency_hz, double power,
                         const WindowSettings& settings) {
  SineWindowWalk walk(coarse, frequency_hz, power, settings);
  SineWindows result;
  while (const auto window = walk.next()) result.windows.push_back(*window);
  result.ended = walk.ended();
  return result;
}

}  // namespace beamid::experiments
