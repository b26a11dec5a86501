// What each of several known poles contributes to a record.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace beamid::experiments {

struct ShapeFit {
  Eigen::MatrixXcd shapes;                      ///< (p x n)
  Eigen::MatrixXd reconstruction;               ///< (p x N)
  Eigen::VectorXd residual_standard_deviation;  ///< (p)
};

/// Shapes in y_i(t) = sum_m Re(shape_im e^(rate_m t)), t = 0 at the first sample, by linear least squares.
///
/// A rate with an imaginary part stands for itself and its conjugate. Growing modes are scaled at the
/// record's end, so that none overflows.
/// @param outputs (p x N), one column per instant
/// @param oscillating (n) whether the rate has an imaginary part that matters: others have real shapes
/// @throws std::invalid_argument when a rate or an output is not a finite number.
ShapeFit fit_shapes(const Eigen::MatrixXd& outputs, double interval,
                    const std::vector<std::complex<double>>& rates, const std::vector<bool>& oscillating);

/// The same of instants that increase as they like, t = 0 where they say (N) [s].
ShapeFit fit_shapes_at(const Eigen::MatrixXd& outputs, const Eigen::VectorXd& time,
                       const std::vector<std::complex<double>>& rates, const std::vector<bool>& oscillating);

}  // namespace beamid::experiments
