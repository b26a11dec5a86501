// One step of one oscillator, exact.
#pragma once

namespace beamid::fem {

/// z'' + d z' + omega^2 z = f over a time t, f linear in between. With the impulse response h, its integral P
/// (the step response) and the integral of that R (the ramp response), all at t,
///
///     z(t)  = z + (-omega^2 P z + h z') + P f + R f'
///     z'(t) = z' + (-omega^2 h z - (omega^2 P + d h) z') + h f + P f',     f' = (f(t) - f) / t.
///
/// Written as increments, so that a slow motion in short steps is not rounded to the size of z itself at
/// each.
struct OscillatorStep {
  double impulse = 0.0;  ///< h [s]
  double step = 0.0;     ///< P [s2]
  double ramp = 0.0;     ///< R [s3]

  /// For any damping, critical and above included, and for omega = 0: power series over t / 2^k, doubled k
  /// times.
  /// @param square omega^2 [1/s2], @param rate d [1/s], @param time t [s]
  static OscillatorStep over(double square, double rate, double time);
};

}  // namespace beamid::fem
