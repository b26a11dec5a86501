#include "experiments/signal/toolbox.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/QR>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "experiments/signal/in_double.hpp"

namespace beamid::experiments {

double chi_square_limit(double freedom, double probability) {
  return quantile(boost::math::chi_squared_distribution<double, InDouble>(freedom), probability);
}

double student_factor(double freedom) {
  constexpr double point = 0.975, normal_point = 1.959963984540054,
                   least = 0.1;  // freedom, where the factor is 1e12; less overflows
  const boost::math::students_t_distribution<double, InDouble> law(std::max(least, freedom));
  return boost::math::quantile(law, point) / normal_point;
}

void require_positive(double value, const std::string& name) {
  if (!(value > 0.0 && std::isfinite(value)))
    throw std::invalid_argument(name + ": " + std::to_string(value) + "; expected a positive number");
}

using Eigen::Index;

bool transforms_fast(Index length, Index largest_factor) {
  for (Index factor = 2; factor <= largest_factor; ++factor)
    while (length % factor == 0) length /= factor;
  return length == 1;
}

Index fast_length_within(Index samples, Index largest_factor) {
  while (!transforms_fast(samples, largest_factor)) --samples;
  return samples;
}

Index even_fast_length_around(Index samples) {
  Index half = (samples + 1) / 2;
  while (!transforms_fast(half)) ++half;
  return 2 * half;
}

namespace {

/// R of (A D, B) in blocks of rows that stay in the cache: what the least squares of many rows need of them
/// ((n + p) x (n + p)). @param scale D (n)
template <class Matrix>
Matrix triangle_of(const Matrix& a, const Eigen::VectorXd& scale, const Matrix& b) {
  constexpr Index block = 1024;
  const Index n = a.cols(), size = n + b.cols();
  Matrix triangle = Matrix::Zero(size, size), stacked(size + block, size);
  for (Index begin = 0; begin < a.rows(); begin += block) {
    const Index count = std::min(block, a.rows() - begin);
    stacked.resize(size + count, size);
    stacked.topRows(size) = triangle;
    stacked.bottomLeftCorner(count, n) = a.middleRows(begin, count) * scale.asDiagonal();
    stacked.bottomRightCorner(count, b.cols()) = b.middleRows(begin, count);
    const Eigen::HouseholderQR<Matrix> factors(stacked);
    triangle = factors.matrixQR().topRows(size).template triangularView<Eigen::Upper>();
  }
  return triangle;
}

template <class Matrix>
Matrix solve(const Matrix& a, const Matrix& b) {
  if (!a.allFinite() || !b.allFinite())
    throw std::invalid_argument("least squares with a value that is not a finite number");
  if (a.size() == 0 || a.isZero(0)) return Matrix::Zero(a.cols(), b.cols());
  const Eigen::VectorXd scale = a.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  constexpr Index many = 16384;
  if (a.rows() > many) {
    constexpr double rounding = 1e-13;  // of that many rows
    const Matrix triangle = triangle_of(a, scale, b);
    Eigen::CompleteOrthogonalDecomposition<Matrix> factors(a.cols(), a.cols());
    factors.setThreshold(rounding);
    factors.compute(triangle.topLeftCorner(a.cols(), a.cols()));
    return scale.asDiagonal() * factors.solve(triangle.topRightCorner(a.cols(), b.cols()));
  }
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
