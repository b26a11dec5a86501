// How sampled inputs run between their samples.
#pragma once

#include <Eigen/Core>

namespace beamid::filters {

/// Inputs of N samples as polynomials of their steps: column k is the path from sample k to the next
/// (StepInput), m (d + 1) rows; behind the last sample it is constant.
struct InputPaths {
  Eigen::MatrixXd columns;        ///< (m (d + 1) x N)
  int degree = 0;                 ///< d
  Eigen::Index band_limited = 0;  ///< steps that have more than a straight line
};

/// Straight from sample to sample. @param samples (m x N)
InputPaths straight_path(const Eigen::MatrixXd& samples);

/// What an anti-aliased converter has recorded: the sum of weighted samples
///
///     u(t_k + s dt) = sum_n w_n(s) u_n,   (C + eps I) w = c(s),   C_ij = c(i - j)
///
/// that is nearest in the mean square over the band below 0.85 of the Nyquist frequency [jerri1977], at the
/// five Chebyshev points of each step, both samples among them, and the polynomial of degree 4 through these.
/// C is the covariance of a signal of that band in which low frequencies weigh more; n reaches over 16
/// samples to each side, near an end over as many as there are. An error of 7e-6 remains at 10 samples per
/// period, 2e-3 at 3 (input_path_test.cpp); in the first and last step 3e-4 at 60 and 1 % at 10.
///
/// Where intervals are not even, beyond `tolerance` from their median, and in runs of fewer than 8 even ones,
/// the path is straight, and an end to either side of it.
/// @param time (N) [s]; @param tolerance of an even interval [s]
InputPaths band_limited_path(const Eigen::VectorXd& time, const Eigen::MatrixXd& samples, double tolerance);

/// Of degree 0 held until the next sample, of 1 straight, of more band-limited.
InputPaths input_path(int degree, const Eigen::VectorXd& time, const Eigen::MatrixXd& samples,
                      double tolerance);

/// The same path in `parts` equal steps of each, (N - 1) parts + 1 columns.
InputPaths in_parts(const InputPaths& path, int parts);

}  // namespace beamid::filters
