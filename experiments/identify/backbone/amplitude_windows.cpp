#include "experiments/identify/backbone/amplitude_windows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "experiments/identify/model_setting.hpp"
#include "experiments/modal/damped_sine_fit.hpp"
#include "experiments/models/identification.hpp"
#include "experiments/models/one_coordinate.hpp"
#include "experiments/signal/amplitude_spectrum.hpp"
#include "experiments/signal/decimation.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::VectorXd;
using std::numbers::pi;

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

Complex displacement_per(Quantity quantity, Complex rate) {
  return quantity == Quantity::acceleration ? 1.0 / (rate * rate)
         : quantity == Quantity::velocity   ? 1.0 / rate
                                            : Complex(1.0);
}

/// The mode in one window.
struct SineWindow {
  Index begin = 0, count = 0;
  DampedSine mode;
  double offset = 0, squares = 0, freedom = 0;
};

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

/// K and C of the window by the joint filter; false where it is lost.
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
  if (found.run.failure || lost(found, w / (2 * pi))) return false;
  to.stiffness = found.found.stiffness;
  to.stiffness_deviation = found.stiffness_deviation;
  to.damping = found.found.damping;
  to.damping_deviation = found.damping_deviation;
  to.frequency_hz = found.found.frequency_hz();
  to.damping_ratio = found.found.damping_ratio();
  return std::isfinite(to.stiffness_deviation) && to.stiffness > 0;
}

}  // namespace

AmplitudeWindows amplitude_windows(const Record& record, const WindowSettings& settings) {
  const Index row = output_channels(record)[0];
  const Quantity quantity = record.channels[static_cast<std::size_t>(row)].quantity;
  const VectorXd signal = record.samples.row(row).transpose();
  const double strongest = strongest_line(signal, record.interval(), settings.band_hz);
  constexpr double first_cycles = 10;  // whose line may lie elsewhere than that of the whole decay
  const Index first = static_cast<Index>(first_cycles / (strongest * record.interval()));
  const double f = first < signal.size() ? strongest_line(signal.head(first), record.interval(),
                                                          std::pair{0.5 * strongest, 1.6 * strongest})
                                         : strongest;
  const int factor = std::max(1, static_cast<int>(1 / (window_samples_per_period * f * record.interval())));
  if (signal.size() < 20 * factor + 24)
    throw std::invalid_argument(
        fmt::format("{} samples, {:.3g} cycles at {:.4g} Hz; expected ten cycles at least", signal.size(),
                    f * record.interval() * double(signal.size()), f));
  const DecimatedSignal coarse = decimate(signal, record.interval(), factor);
  AmplitudeWindows result;
  result.decimation = factor;
  std::vector<SineWindow> sines;
  double w = 2 * pi * f, damping_rate = 0.01 * w, least_left = std::numeric_limits<double>::infinity();
  const Index all = coarse.samples.size();
  const double power = quantity == Quantity::acceleration ? 2 : quantity == Quantity::velocity ? 1 : 0;
  for (Index begin = 0;;) {
    const auto samples = [&](double cycles) {
      return static_cast<Index>(std::ceil(cycles * 2 * pi / (w * coarse.interval)));
    };
    const Index least = std::max<Index>(samples(settings.fewest_cycles), 14);
    if (begin + least > all) {
      result.ended = "the record ends";
      break;
    }
    std::optional<SineWindow> window = sine_window(coarse, begin, least, around(w, damping_rate));
    if (!window) {
      result.ended = "no damped sine fits what follows";
      break;
    }
    w = window->mode.rate.imag();
    // A velocity's amplitude falls with omega A, an acceleration's with omega^2 A: that of the displacement
    // faster, where the next cycles are faster.
    double faster = 0;
    if (power > 0)
      if (const auto next = begin + 2 * least <= all
                                ? sine_window(coarse, begin + least, least, around(w, damping_rate))
                                : std::nullopt)
        faster = power * std::log(std::abs(next->mode.rate) / std::abs(window->mode.rate)) /
                 (coarse.interval * static_cast<double>(least));
    bool whole = true;
    for (int round = 0; round < 3;
         ++round) {  // as long as the amplitude takes, which a short window shows badly
      const double rate = std::max(-window->mode.rate.real(), 0.0) + std::max(faster, 0.0),
                   fall = -std::log(settings.amplitude_ratio) / std::max(rate, 1e-6 * w);
      w = window->mode.rate.imag();
      const Index fewest = std::max<Index>(samples(settings.fewest_cycles), 14),
                  wanted = std::max(fewest, static_cast<Index>(std::min(fall / coarse.interval, 1e9)));
      whole = begin + fewest <= all;
      const Index count = std::min(wanted, all - begin);
      if (!whole || count == window->count) break;
      auto other = sine_window(coarse, begin, count, {window->mode.rate});
      if (!other) break;
      window = other;
    }
    if (!whole) {
      result.ended = "the record ends";
      break;
    }
    const double left_here = std::sqrt(window->squares / window->freedom),
                 middle = std::abs(window->mode.amplitude) *
                          std::exp(window->mode.rate.real() * coarse.interval * 0.5 * double(window->count));
    least_left = std::min(least_left, left_here);
    constexpr double over_least = 3, over_own = 1.5;  // its own holds harmonics and other modes
    if (middle < over_least * least_left && !sines.empty()) {
      result.ended = "the motion is lost in the noise";
      break;
    }
    if (middle < over_own * left_here) {
      result.ended = "no damped sine fits what follows";
      break;
    }
    w = window->mode.rate.imag();
    damping_rate = std::max(-window->mode.rate.real(), 1e-4 * w);
    begin += window->count;
    sines.push_back(std::move(*window));
  }
  if (sines.empty()) throw std::invalid_argument("has no window: " + result.ended);
  const double floor = 1e-7 * coarse.samples.cwiseAbs().maxCoeff();
  std::vector<double> left;
  for (const SineWindow& one : sines) left.push_back(std::sqrt(one.squares / one.freedom));
  std::nth_element(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(left.size() / 2), left.end());
  result.noise = std::max(left[left.size() / 2], floor);
  const FrequencyCourse course(sines, coarse.interval);
  for (const SineWindow& one : sines) {
    const Complex reading = one.mode.amplitude / coarse.response(one.mode.rate);
    const double begin = coarse.interval * static_cast<double>(one.begin);
    const double length = coarse.interval * static_cast<double>(one.count),
                 chirp = (course.at(begin + length) - course.at(begin)) * length / 8,
                 whole = std::abs(reading) * (1 + 2.0 / 45 * chirp * chirp);
    const auto displacement = [&](double t) {
      return whole * std::exp(one.mode.rate.real() * t) / std::pow(course.at(begin + t), power);
    };
    AmplitudeWindow window;
    window.from = record.time[0] + coarse.start + begin;
    window.to = window.from + coarse.interval * static_cast<double>(one.count);
    window.fall =
        std::log(displacement(0) / displacement(window.to - window.from)) / (window.to - window.from);
    window.left = std::sqrt(one.squares / one.freedom);
    take_nodes(one, coarse.interval, displacement, window);
    if (&one == &sines.front()) {
      const Complex phase =
          reading * displacement_per(quantity, one.mode.rate) * std::exp(-one.mode.rate * coarse.start);
      result.first_amplitude = displacement(0);
      result.start = displacement(-coarse.start) * phase / std::abs(phase);
    }
    result.last_amplitude = displacement(window.to - window.from);
    if (filter_window(one, coarse, quantity, settings.mass, std::max(window.left, result.noise), window))
      result.windows.push_back(std::move(window));
  }
  if (result.windows.empty()) throw std::invalid_argument("the joint filter lost the motion in every window");
  result.largest_other = std::sqrt(2.0) * std::sqrt(sines.front().squares / sines.front().freedom) /
                         std::abs(sines.front().mode.amplitude);
  return result;
}

}  // namespace beamid::experiments
