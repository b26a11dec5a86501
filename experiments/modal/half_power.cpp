#include "experiments/modal/half_power.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

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

}  // namespace beamid::experiments
