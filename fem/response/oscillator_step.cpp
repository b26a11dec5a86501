#include "fem/response/oscillator_step.hpp"

#include <cmath>

namespace beamid::fem {

OscillatorStep OscillatorStep::over(double square, double rate, double time) {
  int doublings = 0;
  double t = time;
  while (std::sqrt(square) * t > 0.5 || rate * t > 0.5) {
    t *= 0.5;
    ++doublings;
  }
  // h = sum of terms c_k t^k with k (k + 1) c_{k+1} = -d k c_k - omega^2 c_{k-1}, c_0 = 0, c_1 = 1
  OscillatorStep result;
  double previous = 0.0, term = t;
  for (int k = 1; k < 24; ++k) {
    result.impulse += term;
    result.step += term * t / (k + 1);
    result.ramp += term * t * t / ((k + 1) * (k + 2));
    const double next = -(rate * t * term * k + square * t * t * previous) / (k * (k + 1));
    previous = term;
    term = next;
  }
  for (; doublings > 0; --doublings) {
    const auto [h, p, r] = result;
    result.ramp = r + (r + t * p + (h * p - square * p * r));
    result.step = p + (p + (h * h - square * p * p));
    result.impulse = h + (h - (2.0 * square * p * h + rate * h * h));
    t *= 2.0;
  }
  return result;
}

}  // namespace beamid::fem
