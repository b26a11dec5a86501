// What one mode and an offset leave of a record.
#pragma once

#include <Eigen/Core>
#include <complex>

namespace beamid::experiments {

struct ModeResidual {
  Eigen::MatrixXd reproduced;          ///< the nearest motion, of every sample (p x N)
  Eigen::VectorXd standard_deviation;  ///< of what it leaves of the samples that were measured (p)
};

/// y_i(t) = Re(a_i e^(rate t)) + b_i by linear least squares, channel by channel (fit_shapes); samples that
/// are NaN are left out.
/// @param samples (p x N) @param time of the stamps, even or not (N) [s]
ModeResidual mode_residual(const Eigen::MatrixXd& samples, const Eigen::VectorXd& time,
                           std::complex<double> rate);

/// A channel with the motion in place of what is NaN (N).
Eigen::VectorXd with_mode_in_gaps(const Eigen::VectorXd& signal, double interval, std::complex<double> rate);

}  // namespace beamid::experiments
