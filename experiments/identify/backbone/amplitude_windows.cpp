#include "experiments/identify/backbone/amplitude_windows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/identify/backbone/window_filter.hpp"
#include "experiments/identify/model_setting.hpp"
#include "experiments/signal/amplitude_spectrum.hpp"
#include "experiments/signal/median.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::VectorXd;

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
