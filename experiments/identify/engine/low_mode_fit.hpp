// The nearest motion in the lowest modes of a model, whatever its unknowns are.
#pragma once

#include "experiments/models/joint_model.hpp"
#include "filters/filter_run.hpp"

namespace beamid::experiments {

/// Where the filters of a comparison start.
struct FirstGuess {
  Eigen::VectorXd mean;      ///< of the state (n), the motion at zero
  Eigen::MatrixXd unknowns;  ///< covariance of the unknowns in the state (q x q)
  bool by_lines = false;     ///< by all lines of a driven record, from several starts (driven_fit.hpp)
};

/// L with P = L L^T (q x q), whatever the rank of P.
Eigen::MatrixXd root_of(const Eigen::MatrixXd& covariance);

/// What the state's unknowns change by where all stiffnesses are s times those of the guess (q); empty where
/// a form does not allow it.
Eigen::VectorXd scaled_stiffness(const JointModel& model, const FirstGuess& guess, double s);

/// A record that holds the modes up to some frequency only, as decimation leaves it.
struct LowRecord {
  filters::Measurements measurements;
  double highest_hz;
};

/// Its first samples, from time 0.
filters::Measurements beginning(const filters::Measurements& record, Eigen::Index samples);

struct LowModeGuess {
  FirstGuess guess;
  double square;  ///< mean of what is left of a reading, squared, in its noise; about 1 where that is all
};

/// Minimises, over the unknowns eta = guess + U c, cov(guess) = U U^T,
///
///     J(c) = min over a, b of 1/2 sum_k |L^-1 (y_k - h(z_k))|^2 + 1/2 |c|^2,   z_0 = [Phi(eta) a; Phi(eta)
///     b]
///
/// with the lowest modes Phi(eta) that the model has at eta: variable projection [golub1973], by
/// Levenberg-Marquardt on what the best start leaves. First over a few periods of the fastest of these modes,
/// then over twice as long, and so on, for J of a long oscillation has a minimum for every cycle missed.
///
/// @param noise of the record, a share of each channel's root mean square
/// @returns the constants found, and their covariance; the guess itself where no motion is near the record.
LowModeGuess fit_low_modes(const JointModel& model, const std::vector<Observation>& observations,
                           const LowRecord& record, const FirstGuess& guess, double noise);

}  // namespace beamid::experiments
