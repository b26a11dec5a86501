#include "filters/schemes/matrix_exponential.hpp"

#include <unsupported/Eigen/MatrixFunctions>

namespace beamid::filters {

void exponential_with_derivative(const Eigen::MatrixXd& a, const Eigen::MatrixXd& direction,
                                 Eigen::MatrixXd& value, Eigen::MatrixXd& derivative) {
  const Eigen::Index n = a.rows();
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  block.topLeftCorner(n, n) = block.bottomRightCorner(n, n) = a;
  block.topRightCorner(n, n) = direction;
  const Eigen::MatrixXd exponential = block.exp();
  value = exponential.topLeftCorner(n, n);
  derivative = exponential.topRightCorner(n, n);
}

}  // namespace beamid::filters
