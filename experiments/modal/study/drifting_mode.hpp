// Two fitted poles, or one mode whose frequency and damping follow its amplitude.
#pragma once

#include "experiments/modal/joint_decay_fit.hpp"

namespace beamid::experiments {

/// Whether one mode with a rate that drifts describes a record (p x N) no worse than modes a and b of a joint
/// fit do. Both have as many numbers:
///
///     Re(A e^(s_a t) + B e^(s_b t))    against    Re(exp(c_0 + c_1 t + c_2 t^2 + c_3 t^3)),
///
/// complex A, B, s, c, in the channel where the two are largest, beside the other modes of the fit. Two modes
/// beat, which no cubic follows over more than a cycle; a drifting one does not.
/// Asked of poles less than 4 cycles apart over the record, or over three time constants of the slower.
bool is_one_drifting_mode(const JointDecayFit& fit, std::size_t a, std::size_t b,
                          const Eigen::MatrixXd& target, double interval);

}  // namespace beamid::experiments
