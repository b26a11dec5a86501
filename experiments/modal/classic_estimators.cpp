#include "experiments/modal/classic_estimators.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::VectorXcd;

/// Root of a function that rises through 0 between a and b.
template <class Function>
double root(double a, double b, const Function& function) {
  for (int step = 0; step < 100 && std::abs(b - a) > 1e-13 * (std::abs(a) + std::abs(b)); ++step) {
    const double middle = 0.5 * (a + b);
    (function(middle) > 0 ? b : a) = middle;
  }
  return 0.5 * (a + b);
}

/// (M) e^(-i w m h)
VectorXcd turning(double w, Index count, double interval) {
  VectorXcd wave(count);
  for (Index m = 0; m < count; ++m) wave[m] = std::polar(1.0, -w * interval * static_cast<double>(m));
  return wave;
}

struct Spectrum {
  const VectorXcd& values;
  double interval;

  Complex at(double w) const { return turning(w, values.size(), interval).cwiseProduct(values).sum(); }
  double power(double w) const { return std::norm(at(w)); }

  /// d power / d values: d power = Re sum_m c_m dz_m.
  VectorXcd slope(double w) const { return 2.0 * std::conj(at(w)) * turning(w, values.size(), interval); }

  /// d power / dw
  double rise(double w) const {
    VectorXcd wave = turning(w, values.size(), interval).cwiseProduct(values);
    for (Index m = 0; m < wave.size(); ++m) wave[m] *= Complex(0, -interval * static_cast<double>(m));
    return 2 * (std::conj(at(w)) * wave.sum()).real();
  }

  double peak(double scale) const {
    double best = 0;
    for (int k = -40; k <= 40; ++k)
      if (const double w = 0.1 * k * scale; power(w) > power(best)) best = w;
    return root(best - 0.1 * scale, best + 0.1 * scale, [&](double w) { return -rise(w); });
  }
};

}  // namespace

double relative_power(double damping_rate, double distance, Index count, double interval) {
  const auto power = [&](double w) {
    const Complex exponent(-damping_rate * interval, -w * interval);
    const Complex below = 1.0 - std::exp(exponent);
    if (std::abs(below) < 1e-12) return std::pow(static_cast<double>(count), 2);
    return std::norm((1.0 - std::exp(exponent * static_cast<double>(count))) / below);
  };
  return power(distance) / power(0);
}

double half_power_distance(double damping_rate, Index count, double interval) {
  const double lobe = 2 * std::numbers::pi / (static_cast<double>(count) * interval);
  double beyond = 0.1 * lobe;
  while (relative_power(damping_rate, beyond, count, interval) > 0.5 && beyond < std::numbers::pi / interval)
    beyond += 0.1 * lobe;
  return root(beyond - 0.1 * lobe, beyond,
              [&](double w) { return 0.5 - relative_power(damping_rate, w, count, interval); });
}

double damping_rate_of_distance(double distance, Index count, double interval) {
  if (half_power_distance(0, count, interval) >= distance) return 0;
  return root(0, 2 * distance,
              [&](double rate) { return relative_power(rate, distance, count, interval) - 0.5; });
}

HalfPowerPoints half_power_points(const VectorXcd& values, double interval, double scale) {
  const Spectrum spectrum{values, interval};
  const double peak = spectrum.peak(scale), half = 0.5 * spectrum.power(peak);
  const auto side = [&](double direction) {
    constexpr int farthest = 200;
    for (int k = 1; k <= farthest; ++k)
      if (spectrum.power(peak + direction * 0.1 * k * scale) < half)
        return root(peak + direction * 0.1 * (k - 1) * scale, peak + direction * 0.1 * k * scale,
                    [&](double w) { return half - spectrum.power(w); });
    throw std::invalid_argument(fmt::format("the spectrum does not fall to half its peak within {:.3g} rad/s",
                                            0.1 * farthest * scale));
  };
  HalfPowerPoints points{side(-1), side(1), {}, {}};
  const VectorXcd of_half = 0.5 * spectrum.slope(peak);
  const VectorXcd lower = (of_half - spectrum.slope(points.lower)) / spectrum.rise(points.lower),
                  upper = (of_half - spectrum.slope(points.upper)) / spectrum.rise(points.upper);
  points.centre_slope = 0.5 * (lower + upper);
  points.distance_slope = 0.5 * (upper - lower);
  return points;
}

namespace {

struct DecrementPeak {
  double time = 0;  ///< in samples
  double value = 0;
};

/// Samples [begin, end) on one side of the mean.
struct Lobe {
  Index begin = 0, end = 0;
  Index length() const { return end - begin; }
};

/// Whole lobes; slivers that noise cuts off around a crossing are dropped.
std::vector<Lobe> lobes_of(const Eigen::ArrayXd& centred) {
  std::vector<Lobe> lobes;
  Index begin = 0, longest = 0;
  for (Index k = 1; k < centred.size(); ++k) {
    if ((centred[k] > 0) == (centred[k - 1] > 0)) continue;
    if (begin > 0) {
      lobes.push_back({begin, k});
      longest = std::max(longest, k - begin);
    }
    begin = k;
  }
  std::erase_if(lobes, [&](const Lobe& lobe) { return 2 * lobe.length() < longest; });
  return lobes;
}

/// Vertex of the least-squares parabola around the lobe's extreme sample.
DecrementPeak peak_of(const Eigen::ArrayXd& signal, const Eigen::ArrayXd& centred, const Lobe& lobe) {
  Index extreme = 0;
  centred.segment(lobe.begin, lobe.length()).abs().maxCoeff(&extreme);
  const Index reach = std::max<Index>(1, lobe.length() / 6);
  const Index centre =
      std::clamp(lobe.begin + extreme, reach, std::max<Index>(reach, signal.size() - 1 - reach));
  const auto samples = signal.segment(centre - reach, 2 * reach + 1);
  const auto end = static_cast<double>(reach);
  // y = c0 + c1 k + c2 k^2 for k = -reach..reach, where k, k^2 - mean(k^2) and 1 are orthogonal
  const Eigen::ArrayXd k = Eigen::ArrayXd::LinSpaced(samples.size(), -end, end), squares = k.square();
  const Eigen::ArrayXd bend = squares - squares.mean();
  const double c1 = (k * samples).sum() / squares.sum();
  const double c2 = (bend * samples).sum() / bend.square().sum();
  const double c0 = samples.mean() - c2 * squares.mean();
  const double shift = c2 != 0 ? std::clamp(-0.5 * c1 / c2, -end, end) : 0;
  return {static_cast<double>(centre) + shift, c0 + shift * (c1 + shift * c2)};
}

struct DecrementLine {
  double slope = 0, slope_standard_deviation = 0;
};

DecrementLine regression(const Eigen::ArrayXd& values) {
  const auto count = static_cast<double>(values.size());
  const Eigen::ArrayXd k = Eigen::ArrayXd::LinSpaced(values.size(), -0.5 * (count - 1), 0.5 * (count - 1));
  const double slope = (k * values).sum() / k.square().sum();
  const double scatter = (values - values.mean() - slope * k).square().sum() / std::max(1.0, count - 2);
  return {slope, std::sqrt(scatter / k.square().sum())};
}

}  // namespace

DecrementEstimate logarithmic_decrement(const Eigen::VectorXd& signal, double interval,
                                        const DecrementSettings& settings) {
  const Eigen::ArrayXd values = signal.array(), centred = values - (signal.size() > 0 ? values.mean() : 0);
  std::vector<double> times, swings;
  double largest = 0;
  std::vector<DecrementPeak> peaks;
  for (const Lobe& lobe : lobes_of(centred)) {
    peaks.push_back(peak_of(values, centred, lobe));
    if (peaks.size() < 2) continue;
    const double swing = std::abs(peaks.back().value - peaks[peaks.size() - 2].value);
    largest = std::max(largest, swing);
    if (!(swing > settings.smallest_swing * largest)) {
      peaks.pop_back();
      break;
    }
    swings.push_back(std::log(swing));
  }
  constexpr std::size_t fewest = 4;
  if (peaks.size() < fewest)
    throw std::invalid_argument("logarithmic decrement of " + std::to_string(signal.size()) +
                                " samples: found " + std::to_string(peaks.size()) +
                                " peaks; expected at least " + std::to_string(fewest));
  for (const DecrementPeak& peak : peaks) times.push_back(peak.time);
  const auto as_array = [](const std::vector<double>& data) {
    return Eigen::ArrayXd(Eigen::Map<const Eigen::ArrayXd>(data.data(), static_cast<Index>(data.size())));
  };
  const DecrementLine shrinking = regression(as_array(swings)), timing = regression(as_array(times));
  DecrementEstimate estimate;
  const double turn = 2 * std::numbers::pi;
  estimate.decrement = -2 * shrinking.slope;
  const double hypotenuse = std::hypot(turn, estimate.decrement);
  estimate.damping_ratio = estimate.decrement / hypotenuse;
  estimate.damping_ratio_standard_deviation =
      2 * shrinking.slope_standard_deviation * turn * turn / (hypotenuse * hypotenuse * hypotenuse);
  const double damped_frequency_hz = 0.5 / (timing.slope * interval);
  estimate.frequency_hz = damped_frequency_hz * hypotenuse / turn;
  estimate.frequency_standard_deviation_hz =
      estimate.frequency_hz * timing.slope_standard_deviation / timing.slope;
  estimate.peaks = static_cast<int>(peaks.size());
  return estimate;
}

}  // namespace beamid::experiments
