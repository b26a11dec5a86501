#include "experiments/signal/least_squares.hpp"

#include <Eigen/QR>
#include <stdexcept>

namespace beamid::experiments {
namespace {

template <class Matrix>
Matrix solve(const Matrix& a, const Matrix& b) {
  if (!a.allFinite() || !b.allFinite())
    throw std::invalid_argument("least squares with a value that is not a finite number");
  if (a.size() == 0 || a.isZero(0)) return Matrix::Zero(a.cols(), b.cols());
  const Eigen::VectorXd scale = a.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  return scale.asDiagonal() * (a * scale.asDiagonal()).colPivHouseholderQr().solve(b);
}

}  // namespace

Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return solve(a, b);
}

Eigen::MatrixXcd complex_least_squares(const Eigen::MatrixXcd& a, const Eigen::MatrixXcd& b) {
  return solve(a, b);
}

}  // namespace beamid::experiments
