#include "experiments/identify/backbone/amplitude_windows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/modal/dominant_mode.hpp"
#include "experiments/models/identification.hpp"
#include "experiments/models/oscillator.hpp"
#include "experiments/signal/decimation.hpp"
#include "experiments/signal/spectrum.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

// A free decay in windows of falling amplitude, a damped sine in each.

/// The mode in one window.
struct SineWindow {
  Eigen::Index begin = 0, count = 0;  ///< samples of the decimated signal
  DampedSine mode;
  double offset = 0, squares = 0, freedom = 0;

  double left() const;  ///< rms of the residuals [unit of the signal]
};

struct SineWindows {
  std::vector<SineWindow> windows;
  std::string ended;  ///< why no further window was taken
};

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

double SineWindow::left() const {
  return std::sqrt(squares / freedom);
}

/// Window after window from the first sample. Each is as long as the displacement's amplitude takes to fall
/// to WindowSettings::amplitude_ratio, which its own damped sine says.
/// @param frequency_hz of the mode at the beginning
/// @param power of omega by which the signal exceeds a displacement: 2 of an acceleration
SineWindows sine_windows(const DecimatedSignal& coarse, double frequency_hz, double power,
                         const WindowSettings& settings) {
  SineWindowWalk walk(coarse, frequency_hz, power, settings);
  SineWindows result;
  while (const auto window = walk.next()) result.windows.push_back(*window);
  result.ended = walk.ended();
  return result;
}

// Stiffness and damping of one window of a decay by the joint filter.

/// 1 / s^2 of an acceleration, 1 / s of a velocity, 1 of a displacement e^(s t).
std::complex<double> displacement_per(Quantity quantity, std::complex<double> rate);

using Complex = std::complex<double>;

Complex displacement_per(Quantity quantity, Complex rate) {
  return quantity == Quantity::acceleration ? 1.0 / (rate * rate)
         : quantity == Quantity::velocity   ? 1.0 / rate
                                            : Complex(1.0);
}

/// K and C of the window with their deviations, by model sdof started at its damped sine; false where the
/// filter lost the motion.
/// @param noise standard deviation of a sample
bool filter_window(const SineWindow& sines, const DecimatedSignal& coarse, Quantity quantity, double mass,
                   double noise, AmplitudeWindow& to) {
  const Complex s = sines.mode.rate, x = sines.mode.amplitude * displacement_per(quantity, s), v = s * x;
  const Oscillator oscillator = Oscillator::from_eigenvalue(mass, s);
  const auto model = model_registry().make("sdof", {}, at_one_point(one_coordinate(oscillator), {quantity}));
  const double w = std::abs(s), size = std::abs(x), usual = 0.02 * std::sqrt(oscillator.stiffness * mass);
  constexpr double open = 0.2;
  const auto states = static_cast<Index>(model->motion->state_labels().size());
  VectorXd mean = VectorXd::Zero(states),
           deviation = VectorXd::Constant(states, open * std::abs(sines.mode.amplitude));
  mean.head<4>() << x.real(), v.real(), oscillator.stiffness, oscillator.damping;
  deviation.head<4>() << open * size, open * size * w, open * oscillator.stiffness,
      std::max(std::abs(oscillator.damping), usual);
  IdentificationSettings settings;
  settings.initial.mean = mean;
  settings.initial.covariance = deviation.cwiseAbs2().asDiagonal();
  settings.output_noise = Eigen::MatrixXd::Constant(1, 1, noise * noise);
  settings.passes = 3;
  filters::Measurements measured;
  measured.time = coarse.interval * VectorXd::LinSpaced(sines.count, 0, static_cast<double>(sines.count - 1));
  measured.outputs = coarse.samples.segment(sines.begin, sines.count).transpose().array() - sines.offset;
  const Identification found = identify(*model, measured, settings);
  if (found.run.failure || lost(found, w / (2 * std::numbers::pi))) return false;
  to.stiffness = found.found.stiffness;
  to.stiffness_deviation = found.stiffness_deviation;
  to.damping = found.found.damping;
  to.damping_deviation = found.damping_deviation;
  to.frequency_hz = found.found.frequency_hz();
  to.damping_ratio = found.found.damping_ratio();
  return std::isfinite(to.stiffness_deviation) && to.stiffness > 0;
}

using Complex = std::complex<double>;

constexpr double window_samples_per_period = 8;

double strongest_line(const VectorXd& signal, double interval,
                      const std::optional<std::pair<double, double>>& band) {
  const AmplitudeSpectrum spectrum = amplitude_spectrum(signal, interval);
  const double least = 2 / (interval * static_cast<double>(signal.size()));
  const double from = band ? band->first : least, to = band ? band->second : 0.45 / interval;
  Index best = -1;
  for (Index i = 0; i < spectrum.frequency_hz.size(); ++i)
    if (spectrum.frequency_hz[i] >= from && spectrum.frequency_hz[i] <= to &&
        (best < 0 || spectrum.amplitude[i] > spectrum.amplitude[best]))
      best = i;
  if (best < 0 || !(spectrum.amplitude[best] > 0))
    throw std::invalid_argument(fmt::format("shows no motion between {:.4g} and {:.4g} Hz", from, to));
  return spectrum.frequency_hz[best];
}

/// Angular frequency as it runs from window to window: linear in log omega between their middles, and before
/// the first of them.
class FrequencyCourse {
 public:
  FrequencyCourse(const std::vector<SineWindow>& windows, double interval) {
    for (const SineWindow& window : windows) {
      time_.push_back(interval *
                      (static_cast<double>(window.begin) + 0.5 * static_cast<double>(window.count)));
      log_.push_back(std::log(std::abs(window.mode.rate)));
    }
  }
  double at(double t) const {
    if (time_.size() < 2 || t >= time_.back()) return std::exp(log_.back());
    std::size_t i = 1;
    while (i + 1 < time_.size() && t > time_[i]) ++i;
    return std::exp(log_[i - 1] + (log_[i] - log_[i - 1]) * (t - time_[i - 1]) / (time_[i] - time_[i - 1]));
  }

 private:
  std::vector<double> time_, log_;
};

/// @param displacement at a time after the window's first sample [m]
template <typename Displacement>
void take_nodes(const SineWindow& window, double interval, const Displacement& displacement,
                AmplitudeWindow& to) {
  constexpr Index nodes = 12, fine = 40 * nodes;
  const double length = interval * static_cast<double>(window.count), rate = window.mode.rate.real();
  const VectorXd t = VectorXd::LinSpaced(fine, 0.5, fine - 0.5) * (length / fine),
                 w = (2 * rate * t.array()).exp();
  const double mean = w.dot(t) / w.sum();
  const VectorXd moment = w.array() * (t.array() - mean);
  to.nodes.resize(nodes);
  to.weights.setZero(nodes);
  double behind = 0;
  for (Index k = fine - 1; k >= 0; --k) {
    behind += moment[k];
    to.weights[k * nodes / fine] += behind - 0.5 * moment[k];
  }
  to.weights /= to.weights.sum();
  for (Index j = 0; j < nodes; ++j)
    to.nodes[j] = displacement(length * (static_cast<double>(j) + 0.5) / nodes);
  to.amplitude = std::exp(to.weights.dot(to.nodes.array().log().matrix()));
}

/// Frequency of the mode at the beginning [Hz]; that line may lie elsewhere than that of the whole decay.
double first_frequency_hz(const VectorXd& signal, double interval,
                          const std::optional<std::pair<double, double>>& band) {
  constexpr double first_cycles = 10;
  const double strongest = strongest_line(signal, interval, band);
  const auto first = static_cast<Index>(first_cycles / (strongest * interval));
  return first < signal.size()
             ? strongest_line(signal.head(first), interval, std::pair{0.5 * strongest, 1.6 * strongest})
             : strongest;
}

DecimatedSignal decimated_decay(const VectorXd& signal, double interval, double frequency_hz) {
  const int factor =
      decimation_factor(1 / (window_samples_per_period * frequency_hz * interval), signal.size());
  if (signal.size() < 20 * factor + 24)
    throw std::invalid_argument(
        fmt::format("{} samples, {:.3g} cycles at {:.4g} Hz; expected ten cycles at least", signal.size(),
                    frequency_hz * interval * double(signal.size()), frequency_hz));
  return decimate(signal, interval, factor);
}

/// No less than rounding of the largest sample.
double median_left(const std::vector<SineWindow>& windows, const DecimatedSignal& coarse) {
  std::vector<double> left;
  for (const SineWindow& one : windows) left.push_back(one.left());
  const double floor = 1e-7 * coarse.samples.cwiseAbs().maxCoeff();
  return std::max(median(left), floor);
}

/// Amplitude of the displacement's first harmonic [m] in a window.
class WindowAmplitude {
 public:
  WindowAmplitude(const SineWindow& window, const DecimatedSignal& coarse, const FrequencyCourse& course,
                  double power)
      : course_(course),
        rate_(window.mode.rate.real()),
        power_(power),
        begin_(coarse.interval * static_cast<double>(window.begin)) {
    const Complex reading = window.mode.amplitude / coarse.response(window.mode.rate);
    const double length = coarse.interval * static_cast<double>(window.count),
                 chirp = (course.at(begin_ + length) - course.at(begin_)) * length / 8;
    whole_ = std::abs(reading) * (1 + 2.0 / 45 * chirp * chirp);
  }
  /// t after the window's first sample [s]
  double operator()(double t) const {
    return whole_ * std::exp(rate_ * t) / std::pow(course_.at(begin_ + t), power_);
  }

 private:
  const FrequencyCourse& course_;
  double rate_, power_, begin_, whole_ = 0;
};

}  // namespace

AmplitudeWindows amplitude_windows(const Record& record, const WindowSettings& settings) {
  const Index row = output_channels(record)[0];
  const Quantity quantity = record.channels[static_cast<std::size_t>(row)].quantity;
  const double power = quantity == Quantity::acceleration ? 2 : quantity == Quantity::velocity ? 1 : 0;
  const VectorXd signal = record.samples.row(row).transpose();
  const double frequency_hz = first_frequency_hz(signal, record.interval(), settings.band_hz);
  const DecimatedSignal coarse = decimated_decay(signal, record.interval(), frequency_hz);
  const auto [sines, ended] = sine_windows(coarse, frequency_hz, power, settings);
  if (sines.empty()) throw std::invalid_argument("has no window: " + ended);

  AmplitudeWindows result;
  result.decimation = coarse.factor;
  result.ended = ended;
  result.noise = median_left(sines, coarse);
  const FrequencyCourse course(sines, coarse.interval);
  for (const SineWindow& one : sines) {
    const WindowAmplitude displacement(one, coarse, course, power);
    AmplitudeWindow window;
    window.from = record.time[0] + coarse.start + coarse.interval * static_cast<double>(one.begin);
    window.to = window.from + coarse.interval * static_cast<double>(one.count);
    const double length = window.to - window.from;
    window.fall = std::log(displacement(0) / displacement(length)) / length;
    window.left = one.left();
    take_nodes(one, coarse.interval, displacement, window);
    if (&one == &sines.front()) {
      const Complex phase = one.mode.amplitude / coarse.response(one.mode.rate) *
                            displacement_per(quantity, one.mode.rate) *
                            std::exp(-one.mode.rate * coarse.start);
      result.first_amplitude = displacement(0);
      result.start = displacement(-coarse.start) * phase / std::abs(phase);
    }
    result.last_amplitude = displacement(length);
    if (filter_window(one, coarse, quantity, settings.mass, std::max(window.left, result.noise), window))
      result.windows.push_back(std::move(window));
  }
  if (result.windows.empty()) throw std::invalid_argument("the joint filter lost the motion in every window");
  result.largest_other = std::sqrt(2.0) * sines.front().left() / std::abs(sines.front().mode.amplitude);
  return result;
}

}  // namespace beamid::experiments
