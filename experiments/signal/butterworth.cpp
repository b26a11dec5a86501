#include "experiments/signal/butterworth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace beamid::experiments {
namespace {

/// e^x - 1 without cancellation near x = 0, where the corner of a high-pass lies.
std::complex<double> exponential_minus_one(std::complex<double> x) {
  const double half_sine = std::sin(0.5 * x.imag());
  return {std::expm1(x.real()) * std::cos(x.imag()) - 2 * half_sine * half_sine,
          std::exp(x.real()) * std::sin(x.imag())};
}

/// c0 z^2 + c1 z + c2 in powers of d = z - 1: the double zero of a high-pass at z = 1 stays exact.
std::complex<double> polynomial(double c0, double c1, double c2, std::complex<double> d) {
  return c0 * d * d + (2 * c0 + c1) * d + (c0 + c1 + c2);
}

void apply_in_place(const Biquad& section, Eigen::VectorXd& signal, FilterStart start) {
  double state1 = 0, state2 = 0;
  if (start == FilterStart::steady && signal.size() > 0) {
    const double x = signal[0];
    const double y = x * (section.b0 + section.b1 + section.b2) / (1 + section.a1 + section.a2);
    state1 = y - section.b0 * x;
    state2 = section.b2 * x - section.a2 * y;
  }
  for (double& sample : signal) {  // transposed direct form II
    const double x = sample, y = section.b0 * x + state1;
    state1 = section.b1 * x - section.a1 * y + state2;
    state2 = section.b2 * x - section.a2 * y;
    sample = y;
  }
}

double largest_pole_magnitude(const Biquad& section) {
  const double discriminant = section.a1 * section.a1 - 4 * section.a2;
  if (discriminant < 0) return std::sqrt(section.a2);
  return 0.5 * (std::abs(section.a1) + std::sqrt(discriminant));
}

}  // namespace

CascadedFilter cascade(const CascadedFilter& first, const CascadedFilter& second) {
  if (first.interval != second.interval) {
    std::ostringstream message;
    message << "filters designed for " << first.interval << " s and " << second.interval
            << " s; expected one sampling interval";
    throw std::invalid_argument(message.str());
  }
  CascadedFilter both = first;
  both.sections.insert(both.sections.end(), second.sections.begin(), second.sections.end());
  return both;
}

Eigen::VectorXd filter_causally(const CascadedFilter& filter, const Eigen::VectorXd& signal,
                                FilterStart start) {
  Eigen::VectorXd result = signal;
  for (const Biquad& section : filter.sections) apply_in_place(section, result, start);
  return result;
}

Eigen::VectorXd filter_forward_backward(const CascadedFilter& filter, const Eigen::VectorXd& signal) {
  const Eigen::Index count = signal.size();
  if (count < 2)
    throw std::invalid_argument("signal of " + std::to_string(count) +
                                " samples; expected at least 2 for zero-phase filtering");
  constexpr double negligible = 1e-6;
  const Eigen::Index pad = std::min(count - 1, settling_samples(filter, negligible));
  Eigen::VectorXd extended(count + 2 * pad);
  extended << 2 * signal[0] - signal.segment(1, pad).reverse().array(), signal.array(),
      2 * signal[count - 1] - signal.segment(count - 1 - pad, pad).reverse().array();
  extended = filter_causally(filter, extended, FilterStart::steady).reverse().eval();
  extended = filter_causally(filter, extended, FilterStart::steady).reverse().eval();
  return extended.segment(pad, count);
}

std::complex<double> response(const CascadedFilter& filter, std::complex<double> rate) {
  const std::complex<double> d = exponential_minus_one(rate * filter.interval);
  std::complex<double> product = 1;
  for (const Biquad& section : filter.sections)
    product *= polynomial(section.b0, section.b1, section.b2, d) / polynomial(1, section.a1, section.a2, d);
  return product;
}

std::complex<double> zero_phase_response(const CascadedFilter& filter, std::complex<double> rate) {
  return response(filter, rate) * response(filter, -rate);
}

Eigen::Index settling_samples(const CascadedFilter& filter, double tolerance) {
  if (!(tolerance > 0 && tolerance < 1)) {
    std::ostringstream message;
    message << "transient tolerance " << tolerance << "; expected a value between 0 and 1";
    throw std::invalid_argument(message.str());
  }
  double slowest = 0;
  for (const Biquad& section : filter.sections) slowest = std::max(slowest, largest_pole_magnitude(section));
  if (!(slowest < 1)) {
    std::ostringstream message;
    message << "filter with a pole of magnitude " << slowest << "; expected all below 1";
    throw std::invalid_argument(message.str());
  }
  return slowest > 0 ? static_cast<Eigen::Index>(std::ceil(std::log(tolerance) / std::log(slowest))) : 0;
}

namespace {

enum class Band { low, high };

void check_butterworth(int order, double corner_hz, double interval) {
  std::ostringstream message;
  if (!(interval > 0 && std::isfinite(interval)))
    message << "sampling interval " << interval << " s; expected a positive value";
  else if (order < 1 || order > 8)
    message << "Butterworth filter of order " << order << "; expected 1 to 8";
  else if (!(corner_hz > 0 && corner_hz < 0.5 / interval))
    message << "corner frequency " << corner_hz << " Hz; expected a value between 0 and " << 0.5 / interval
            << " Hz, half the sampling rate";
  if (const std::string text = message.str(); !text.empty()) throw std::invalid_argument(text);
}

/// Section of the analogue pole pair s^2 + c W s + W^2, with s = (1 - 1/z)/(1 + 1/z).
Biquad second_order(Band band, double c, double W) {
  const double scale = 1 / (1 + c * W + W * W);
  Biquad section;
  section.a1 = 2 * (W * W - 1) * scale;
  section.a2 = (1 - c * W + W * W) * scale;
  section.b0 = section.b2 = (band == Band::low ? W * W : 1) * scale;
  section.b1 = (band == Band::low ? 2 : -2) * section.b0;
  return section;
}

/// Section of the real pole s + W.
Biquad first_order(Band band, double W) {
  Biquad section;
  section.a1 = (W - 1) / (W + 1);
  section.b0 = (band == Band::low ? W : 1) / (W + 1);
  section.b1 = band == Band::low ? section.b0 : -section.b0;
  return section;
}

CascadedFilter design(Band band, int order, double corner_hz, double interval) {
  check_butterworth(order, corner_hz, interval);
  const double W = std::tan(std::numbers::pi * corner_hz * interval);
  CascadedFilter filter{{}, interval};
  for (int k = 0; k < order / 2; ++k)
    filter.sections.push_back(
        second_order(band, 2 * std::sin(std::numbers::pi * (2 * k + 1) / (2 * order)), W));
  if (order % 2 == 1) filter.sections.push_back(first_order(band, W));
  return filter;
}

}  // namespace

CascadedFilter butterworth_low_pass(int order, double corner_hz, double interval) {
  return design(Band::low, order, corner_hz, interval);
}

CascadedFilter butterworth_high_pass(int order, double corner_hz, double interval) {
  return design(Band::high, order, corner_hz, interval);
}

}  // namespace beamid::experiments
