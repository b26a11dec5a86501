// Frequency responses of two models, sampled so that no resonance of either is missed.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/damping.hpp"

namespace beamid::experiments {

/// Frequencies from `from` to `to` [Hz], even on a logarithmic scale, and about each resonance closer
/// together the nearer to it: a step at the peak is a fortieth of its half-power width.
/// @param angular_frequency of the modes of every model [rad/s], zeros left aside.
Eigen::VectorXd response_grid(double from, double to, const std::vector<Eigen::VectorXd>& angular_frequency,
                              const fem::DampingLaw& damping);

struct ResponseDifference {
  double relative = 0.0;  ///< sqrt(integral (|H_r| - |H|)^2 df / integral |H|^2 df)
  double worst_db = 0.0;  ///< 20 log10 |H_r / H|, where its magnitude is largest
  double worst_hz = 0.0;  ///< NaN where nothing differs
};

/// @param full, reduced magnitudes at the frequencies, ascending (N).
ResponseDifference compare_magnitudes(const Eigen::VectorXd& frequency_hz, const Eigen::VectorXd& full,
                                      const Eigen::VectorXd& reduced);

}  // namespace beamid::experiments
