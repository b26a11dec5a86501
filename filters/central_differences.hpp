// Jacobians of models that do not give their own.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace beamid::filters {

/// df/dz (rows x n) at z (n) by central differences; f(z, value) writes value (rows).
///
/// The step eps^(1/3) max(|z_i|, 1e-3) balances truncation, of the second order in it, against rounding.
template <class Function>
void central_differences(const Function& f, const Eigen::VectorXd& z, Eigen::Index rows,
                         Eigen::MatrixXd& jacobian) {
  const double relative_step = std::cbrt(std::numeric_limits<double>::epsilon());
  Eigen::VectorXd point = z, above(rows), below(rows);
  jacobian.resize(rows, z.size());
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const double step = relative_step * std::max(std::abs(z[i]), 1e-3);
    point[i] = z[i] + step;
    f(point, above);
    point[i] = z[i] - step;
    f(point, below);
    point[i] = z[i];
    jacobian.col(i) = (above - below) / (2.0 * step);
  }
}

}  // namespace beamid::filters
