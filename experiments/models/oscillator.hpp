// One degree of freedom in the terms researchers use: frequency and damping ratio, or stiffness and damping.
#pragma once

#include <cmath>
#include <complex>
#include <numbers>

#include "fem/assembly.hpp"

namespace beamid::experiments {

/// M x'' + C x' + K x = 0.
struct Oscillator {
  double mass = 0.0;       ///< M [kg]
  double stiffness = 0.0;  ///< K [N/m]
  double damping = 0.0;    ///< C [N s/m]

  static Oscillator from_frequency(double mass, double angular_frequency, double damping_ratio) {
    return {mass, mass * angular_frequency * angular_frequency,
            2.0 * damping_ratio * angular_frequency * mass};
  }
  /// The oscillator whose free decay is e^(lambda t): K = M |lambda|^2, C = -2 M Re lambda.
  static Oscillator from_eigenvalue(double mass, std::complex<double> lambda) {
    return {mass, mass * std::norm(lambda), -2.0 * mass * lambda.real()};
  }

  double angular_frequency() const { return std::sqrt(stiffness / mass); }  ///< undamped [rad/s]
  double frequency_hz() const { return angular_frequency() / (2.0 * std::numbers::pi); }  ///< undamped
  double damping_ratio() const { return damping / (2.0 * std::sqrt(stiffness * mass)); }
  /// lambda = -xi w + i w sqrt(1 - xi^2) [rad/s]; light damping only.
  std::complex<double> eigenvalue() const {
    const double w = angular_frequency(), xi = damping_ratio();
    return {-xi * w, w * std::sqrt(1.0 - xi * xi)};
  }
};

// An oscillator as a structural system of one coordinate, which is what a reduction would have left.

/// M q'' + C q' + K q = u, y = q, all matrices 1 x 1. @throws std::invalid_argument unless K > 0.
fem::StructuralSystem one_coordinate(const Oscillator& oscillator);

}  // namespace beamid::experiments
