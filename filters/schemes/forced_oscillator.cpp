#include "filters/schemes/forced_oscillator.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace beamid::filters {

using Eigen::Index, Eigen::Matrix2d, Eigen::Vector2d;

namespace {

constexpr double farthest = 3.0;  // of the series: its rounding grows with e^|Z|

// |Z| in coordinates that are scaled to make it small.
double size_of(const Matrix2d& z) {
  return std::max(std::abs(z(0, 0)), std::abs(z(1, 1))) + std::sqrt(std::abs(z(0, 1) * z(1, 0)));
}

}  // namespace

bool ForcedOscillator::takes(const Matrix2d& z) {
  const double size = size_of(z);
  return size <= farthest || std::abs(z.determinant()) >= size;  // both eigenvalues beyond 1
}

ForcedOscillator::ForcedOscillator(const Matrix2d& z, const Matrix2d& exponential, const Pushes& pushes)
    : z_(z), exponential_(exponential) {
  const double size = size_of(z);
  if (size <= farthest) {
    constexpr double rounding = 1e-18;
    count_ = 1;
    for (double term = 1.0; term > rounding && count_ < most_terms; ++count_)
      term *= size / static_cast<double>(count_ + 1);
    terms_ = terms(pushes);
    value_.setZero();
    for (Index k = count_ - 1; k >= 0; --k) value_ = z_ * value_ + terms_.col(k);
    return;
  }
  inverse_ = z.inverse();
  terms_.resize(2, pushes.cols());
  Vector2d above = Vector2d::Zero();  // (j + 1) a_(j+1)
  for (Index j = pushes.cols() - 1; j >= 0; --j) {
    terms_.col(j) = inverse_ * (above - pushes.col(j));
    above = static_cast<double>(j) * terms_.col(j);
  }
  value_ = terms_.rowwise().sum() - exponential_ * terms_.col(0);
}

ForcedOscillator::Terms ForcedOscillator::terms(const Pushes& pushes) const {
  Terms found = Terms::Zero(2, count_);
  for (Index j = 0; j < pushes.cols(); ++j) {
    double weight = 1.0 / static_cast<double>(j + 1);
    for (Index k = 0; k < count_; ++k) {
      found.col(k) += weight * pushes.col(j);
      weight /= static_cast<double>(k + j + 2);
    }
  }
  return found;
}

Vector2d ForcedOscillator::derivative(const Matrix2d& turn, const Matrix2d& exponential_slope,
                                      const Pushes& slopes) const {
  if (count_ > 0) {
    const Terms added = terms(slopes);
    Vector2d sum = Vector2d::Zero(), slope = sum;
    for (Index k = count_ - 1; k >= 0; --k) {
      slope = z_ * slope + turn * sum + added.col(k);
      sum = z_ * sum + terms_.col(k);
    }
    return slope;
  }
  Vector2d above = Vector2d::Zero(), change = above, sum = above;
  for (Index j = slopes.cols() - 1; j >= 0; --j) {
    change = inverse_ * (above - slopes.col(j) - turn * terms_.col(j));
    sum += change;
    above = static_cast<double>(j) * change;
  }
  return sum - exponential_slope * terms_.col(0) - exponential_ * change;
}

}  // namespace beamid::filters
