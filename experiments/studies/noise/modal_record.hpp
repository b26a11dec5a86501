// What a sensor on a continuum records, mode by mode.
#pragma once

#include <cstdint>

#include "experiments/record/record.hpp"
#include "fem/beam.hpp"

namespace beamid::experiments {

enum class Blow { release, hammer };

/// Modes of a beam as one point sees them: x_i = Re(a_i e^(lambda_i t)).
struct ModalMotion {
  Eigen::VectorXcd amplitude;  ///< a at the point (k) [m]
  Eigen::VectorXcd rate;       ///< lambda (k) [rad/s]

  double stiffness(Eigen::Index i) const { return std::norm(rate[i]); }   ///< K/M [1/s2]
  double damping(Eigen::Index i) const { return -2.0 * rate[i].real(); }  ///< C/M [1/s]
  double size(Eigen::Index i, Quantity observed) const;                   ///< |a lambda^n|, at t = 0
};

/// From rest in the static shape of a force at the point, or by a half-sine blow there of this duration [s];
/// the first mode moves by `deflection` [m] in both.
/// @param damping_ratios of the modes kept (k)
ModalMotion modal_motion(const fem::Beam& beam, int elements, const Eigen::VectorXd& damping_ratios,
                         Blow blow, double deflection, double blow_duration);

/// The sum of all modes, from an instant on that differs from seed to seed by up to a period of the first,
/// hence with other phases; white noise of deviation `noise` on top.
struct ModalRecord {
  double interval = 0.0;    ///< [s]
  Eigen::VectorXd samples;  ///< (N)
  Eigen::VectorXd higher;   ///< part of the modes above the first (N)
  double start = 0.0;       ///< after the blow [s]
};
ModalRecord modal_record(const ModalMotion& motion, Quantity observed, double interval, double duration,
                         double noise, std::uint64_t seed, std::uint64_t stream);

}  // namespace beamid::experiments
