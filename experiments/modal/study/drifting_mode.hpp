// Two fitted poles, or one mode whose frequency and damping follow its amplitude.
#pragma once

#include "experiments/modal/joint_decay_fit.hpp"

namespace beamid::experiments {

/// Squares of the residual of modes a and b of a joint fit in one channel, and of one drifting mode in their
/// place; see is_one_drifting_mode().
struct PairAgainstDrift {
  double left_by_pair = 0.0, left_by_drift = 0.0;
};
PairAgainstDrift pair_against_drift(const JointDecayFit& fit, std::size_t a, std::size_t b,
                                    const Eigen::MatrixXd& target, double interval, Eigen::Index channel);

/// Whether one mode with a rate that drifts describes a record (p x N) no worse than modes a and b of a joint
/// fit do. Both have as many numbers:
///
///     Re(A e^(s_a t) + B e^(s_b t))    against    Re(exp(c_0 + c_1 t + c_2 t^2 + c_3 t^3)),
///                                      or         Re(exp(c_0 + c_1 t + c_2 a + c_3 a^2)),   a = e^(-d t)
///
/// with d the mean damping rate of both, complex A, B, s, c, in the channel where the two are largest, beside
/// the other modes of the fit. Two modes beat, which no cubic follows over more than a cycle; a drifting one
/// does not. Asked of poles less than 4 cycles apart over the record, or over three time constants of the
/// slower.
bool is_one_drifting_mode(const JointDecayFit& fit, std::size_t a, std::size_t b,
                          const Eigen::MatrixXd& target, double interval);

}  // namespace beamid::experiments
