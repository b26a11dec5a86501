// The inputs of a model between one sample and the next.
#pragma once

#include <Eigen/Core>

namespace beamid::filters {

/// u(t_k + s dt) = sum_j p_j s^j,  0 <= s <= 1, of m inputs over one step, as the vector [p_0; p_1; ...; p_d]
/// (m (d + 1)). p_0 is u_k itself; of degree 0 the inputs are held, of degree 1 they run straight. Paths of
/// records: step_input.hpp.
///
/// Schemes that evaluate the rate take u at their stages. The (2,2) Pade step is Obreshkov's,
/// x+ - x = dt/2 (x' + x'+) - dt^2/12 (x''+ - x''): of the inputs it takes
///
///     mean = (u(0) + u(1)) / 2 - (u'(1) - u'(0)) / 12,   slope = u(1) - u(0),
///
/// so that it moves polynomials up to the degree 4 exactly [hairer1993, ch. II.13].
class StepInput {
 public:
  static constexpr int highest_degree = 4;

  /// @param path which must outlive this; empty: no input
  /// @param inputs m; 0, of a model that does not say: all of the path, held
  /// @throws std::invalid_argument when the path is no multiple of m, or d above the highest degree.
  StepInput(const Eigen::VectorXd& path, Eigen::Index inputs);

  Eigen::Index size() const { return inputs_; }    ///< m; 0 without a path
  Eigen::Index degree() const { return degree_; }  ///< d
  /// p_j (m)
  auto coefficient(Eigen::Index j) const { return path_.segment(j * inputs_, inputs_); }

  Eigen::VectorXd at(double s) const;  ///< u (m)
  Eigen::VectorXd mean() const;        ///< (m)
  Eigen::VectorXd slope() const;       ///< (m)

 private:
  const Eigen::VectorXd& path_;
  Eigen::Index inputs_, degree_ = 0;
};

// How sampled inputs run between their samples.

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
