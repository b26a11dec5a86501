// The exact Euler-Bernoulli cantilever with a tip body: the oracle of the finite elements.
#pragma once

#include "fem/beam.hpp"

namespace beamid::fem {

/// Mode i (from 1) of the continuum, no mesh. With b = beta L, mu = M/(m L), kappa = J/(m L^3) (m: mass per
/// length), b is the i-th positive root of [bhat1976]
///
///     1 + cos b cosh b + mu b (cos b sinh b - sin b cosh b)
///       - kappa b^3 (sin b cosh b + cos b sinh b) + mu kappa b^4 (1 - cos b cosh b) = 0
///
/// and omega = b^2 sqrt(EI / (m L^4)).
class ExactMode {
 public:
  /// @throws std::invalid_argument when the beam is impossible or i < 1.
  ExactMode(const Cantilever& beam, int i);

  double root() const { return root_; }  ///< b [-]
  double angular_frequency() const;      ///< omega [rad/s]
  double frequency_hz() const;

  /// Deflection at x [m], scaled to 1 at the tip.
  double shape(double x) const;

  /// Modal mass referred to the tip: (integral m phi^2 dx + M phi(L)^2 + J phi'(L)^2) / phi(L)^2 [kg].
  double mass_at_tip() const { return mass_at_tip_; }

  /// Amplitude of this mode at the tip after release from a static tip deflection [m]:
  /// K d / (omega^2 mass_at_tip), K = 3 EI / L^3.
  double release_amplitude(double tip_deflection) const;

 private:
  double unscaled_shape(double y) const;  // at y = b x / L
  double unscaled_slope(double y) const;  // d/dy

  Cantilever beam_;
  double root_ = 0.0;
  double growing_ = 0.0, decaying_ = 0.0;  // coefficients of e^(y-b) and e^-y in cosh y - sigma sinh y
  double sigma_ = 0.0;
  double mass_at_tip_ = 0.0;
};

}  // namespace beamid::fem
