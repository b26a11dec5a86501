// Whether the modes of a free decay keep their phases along the record.
#pragma once

#include "experiments/modal/joint_decay_fit.hpp"
#include "experiments/modal/study/modal_study.hpp"

namespace beamid::experiments {

// Two fitted poles, or one mode whose frequency and damping follow its amplitude.

/// Squares of the residual of modes a and b of a joint fit in some channels, each in units of its noise near
/// a, and of one mode in their place that drifts in all of them alike; see is_one_drifting_mode().
struct PairAgainstDrift {
  double left_by_pair = 0.0, left_by_drift = 0.0;
};
PairAgainstDrift pair_against_drift(const JointDecayFit& fit, std::size_t a, std::size_t b,
                                    const Eigen::MatrixXd& target, double interval,
                                    const std::vector<Eigen::Index>& channels);

/// Whether one mode with a rate that drifts describes a record (p x N) no worse than modes a and b of a joint
/// fit do:
///
///     Re(A e^(s_a t) + B e^(s_b t))    against    Re(exp(c_0 + c_1 t + c_2 t^2 + c_3 t^3)),
///                                      or         Re(exp(c_0 + c_1 t + c_2 a + c_3 a^2 + c_4 a^3)),  a =
///                                      e^(-d t)
///
/// with d the mean damping rate of both, complex A, B, s, c, in the channel where the two are largest, beside
/// the other modes of the fit. Two modes beat, which no cubic follows over more than a cycle; a drifting one
/// does not. Asked of poles less than 4 cycles apart over the record, or over three time constants of the
/// slower.
bool is_one_drifting_mode(const JointDecayFit& fit, std::size_t a, std::size_t b,
                          const Eigen::MatrixXd& target, double interval);

/// Even stamps of a clock whose intervals scatter, and frequencies that change, let phases wander about those
/// of the fit. In sections of the record, the fitted rates held, each mode's own amplitude is A_s e^(i phi_s)
/// of the joint one's. Where the phi_s, a line through them taken out, are larger than noise makes them
/// (chi^2 over modes and sections beyond its 99 % point), a random walk of them,
///
///     E (phi_t - phi_s)^2 = q |t - s|,
///
/// adds q max(sigma / 2, 1.2 / T) to the variance of the angular frequency of a mode of damping rate sigma in
/// a record of length T (weighted by e^(-2 sigma t), or not at all), and (q / 4)^2 to that of its rate. A
/// clock's walk is in time: q / omega^2, from all modes together. Beyond the 99.99 % point a warning says how
/// large it is.
/// @param fit of found's modes, in their order
void follow_phases(const JointDecayFit& fit, RecordModes& found);

}  // namespace beamid::experiments
