#include "experiments/signal/butterworth.hpp"

#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace beamid::experiments {
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
