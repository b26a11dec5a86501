#include "filters/triangular_root.hpp"

#include <cmath>

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

void TriangularRoot::restart(Index size) {
  root_.setIdentity(size, size);
  terms_.setZero(size);
  sums_.setZero(size);
}

void TriangularRoot::take_in(const MatrixXd& seen, const VectorXd& variances) {
  for (Index i = 0; i < seen.rows(); ++i) take_in(seen, i, variances[i]);
}

void TriangularRoot::take_in(const MatrixXd& seen, Index output, double variance) {
  const Index r = root_.cols();
  const double weight = variance > 0.0 ? 1.0 / variance : 1.0;
  partial_.setZero(r);
  double below = variance;
  for (Index j = 0; j < r; ++j) {
    double* column = &root_(0, j);
    double z = 0.0, without_signs = 0.0;
    for (Index i = 0; i <= j; ++i) {
      const double term = seen(output, i) * column[i];
      z += term;
      without_signs += std::abs(term);
    }
    terms_[j] += weight * without_signs * without_signs;
    sums_[j] += weight * z * z;
    const double above = below + z * z;
    if (z == 0.0 || !(above > 0.0)) continue;
    const double kept = std::sqrt(below / above), share = below > 0.0 ? z / std::sqrt(below * above) : 0.0;
    for (Index i = 0; i <= j; ++i) {
      const double before = column[i];
      column[i] = kept * before - share * partial_[i];
      partial_[i] += z * before;
    }
    below = above;
  }
}

bool TriangularRoot::cancels() {
  constexpr double digits_lost = 1e4, smallest = 1e-100;
  const bool cancelling = (terms_.array() > digits_lost * digits_lost * sums_.array()).any();
  terms_.setZero();
  sums_.setZero();
  return cancelling || root_.diagonal().minCoeff() < smallest;
}

}  // namespace beamid::filters
