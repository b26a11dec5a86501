// The functions that e^(A dt) of an oscillator is made of.
#pragma once

#include <limits>

#include "filters/algorithms/scalar.hpp"

namespace beamid::filters::algorithms {

/// c(z) = cosh sqrt z, s(z) = sinh(sqrt z) / sqrt z, s'(z) = ds/dz; entire functions: cos and sin below zero.
template <class Scalar>
struct EntireFunctions {
  Scalar c, s, slope;
};

/// Their power series for |z| <= 1/16; the first terms left out are below 1e-17.
///
///     c = sum z^k / (2k)!,   s' = sum k z^(k-1) / (2k+1)!,   s = c - 2 z s'
template <class Scalar>
[[gnu::always_inline]] inline EntireFunctions<Scalar> entire_functions(const Scalar& z) {
  const Scalar z2 = z * z, z4 = z2 * z2;
  const Scalar c = (1.0 + z * (1.0 / 2)) + z2 * (1.0 / 24 + z * (1.0 / 720)) +
                   z4 * ((1.0 / 40320 + z * (1.0 / 3628800)) + z2 * (1.0 / 479001600));
  const Scalar slope = (1.0 / 6 + z * (1.0 / 60)) + z2 * (1.0 / 1680 + z * (1.0 / 90720)) +
                       z4 * (1.0 / 7983360 + z * (1.0 / 1037836800));
  return {c, c - 2.0 * z * slope, slope};
}

/// e^-delta c(z), e^-delta s(z) and e^-delta s'(z) for |z| and delta^2 up to 1/16.
template <class Scalar>
[[gnu::always_inline]] inline EntireFunctions<Scalar> damped_nearby(const Scalar& z, const Scalar& delta) {
  const EntireFunctions<Scalar> f = entire_functions(z), g = entire_functions<Scalar>(delta * delta);
  const Scalar decay = g.c - delta * g.s;  // e^-delta
  return {decay * f.c, decay * f.s, decay * f.slope};
}

/// The same far away: both arguments are halved h times, z -> z/4 and delta -> delta/2, and the results
/// doubled back by c(4z) = c^2 + z s^2, s(4z) = c s, s'(4z) = (c s' + s^2/2)/4. Nothing overflows that the
/// result does not. Relative error about 2^h eps, as the rounding of the arguments alone causes.
template <class Scalar>
[[gnu::noinline]] EntireFunctions<Scalar> damped_far_away(Scalar z, Scalar delta, Scalar size, double limit) {
  constexpr int most = 64;
  Scalar halved = 0.0;
  int halvings = 0;
  for (; any(size > limit) && halvings < most; ++halvings) {
    const auto large = size > limit;
    z = select(large, 0.25 * z, z);
    delta = select(large, 0.5 * delta, delta);
    size = select(large, 0.25 * size, size);
    halved = select(large, halved + 1.0, halved);
  }
  z = select(size > limit, Scalar(std::numeric_limits<double>::quiet_NaN()), z);  // beyond all reason
  EntireFunctions<Scalar> f = damped_nearby(z, delta);
  for (; halvings > 0; --halvings) {
    const auto due = halved >= Scalar(static_cast<double>(halvings));
    const EntireFunctions<Scalar> d{f.c * f.c + z * f.s * f.s, f.c * f.s,
                                    0.25 * (f.c * f.slope + 0.5 * f.s * f.s)};
    f = {select(due, d.c, f.c), select(due, d.s, f.s), select(due, d.slope, f.slope)};
    z = select(due, 4.0 * z, z);
  }
  return f;
}

/// For any z and delta; what is too large for any of its lanes takes the longer way for all.
template <class Scalar>
[[gnu::always_inline]] inline EntireFunctions<Scalar> damped_entire_functions(const Scalar& z,
                                                                              const Scalar& delta) {
  constexpr double limit = 1.0 / 16.0;
  const Scalar size = larger(magnitude(z), delta * delta);
  if (any(size > limit)) [[unlikely]]
    return damped_far_away<Scalar>(z, delta, size, limit);
  return damped_nearby(z, delta);
}

/// e^x, for scalars that the standard library has no function for.
template <class Scalar>
[[gnu::always_inline]] inline Scalar exponential(const Scalar& x) {
  return damped_entire_functions<Scalar>(0.0, -x).c;
}

}  // namespace beamid::filters::algorithms
