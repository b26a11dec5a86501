#include "experiments/identify/twins/minor_system.hpp"

#include <array>
#include <bit>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

double minor_of(const MatrixXd& matrix, unsigned subset) {
  std::vector<Index> rows;
  for (Index i = 0; i < matrix.rows(); ++i)
    if (subset >> i & 1u) rows.push_back(i);
  return rows.empty() ? 1.0 : MatrixXd(matrix(rows, rows)).determinant();
}

}  // namespace

MinorSystem::MinorSystem(const MatrixXd& matrix, const VectorXd& spectrum) : n_(matrix.rows()) {
  const unsigned subsets = 1u << n_;
  for (unsigned subset = 0; subset < subsets; ++subset) {
    minor_.push_back(minor_of(matrix, subset));
    order_.push_back(std::popcount(subset));
  }
  sums_ = VectorXd::Zero(n_ + 1);
  sums_[0] = 1.0;
  for (Index i = 0; i < n_; ++i)
    for (Index r = i + 1; r > 0; --r) sums_[r] += spectrum[i] * sums_[r - 1];
}

void MinorSystem::at(const ComplexVector& u, PathComplex tau, Value& value) const {
  std::array<PathComplex, 1u << most_paths_order> product;
  std::array<PathComplex, most_paths_order> k;
  for (Index i = 0; i < n_; ++i) k[static_cast<std::size_t>(i)] = std::exp(u[i]);
  value.residual.setZero(n_);
  value.motion.setZero(n_);
  value.jacobian.setZero(n_, n_);
  value.size.setZero(n_);
  product[0] = 1.0;
  for (unsigned subset = 1; subset < minor_.size(); ++subset) {
    const auto lowest = static_cast<std::size_t>(std::countr_zero(subset));
    product[subset] = product[subset & (subset - 1)] * k[lowest];
    const Index r = order_[subset] - 1;
    const PathComplex scaled = product[subset] / sums_[r + 1],
                      term = (1.0 + tau * (minor_[subset] - 1.0)) * scaled;
    value.residual[r] += term;
    value.motion[r] += (minor_[subset] - 1.0) * scaled;
    value.size[r] += std::abs(term.real()) + std::abs(term.imag());
    for (unsigned left = subset; left != 0; left &= left - 1)
      value.jacobian(r, std::countr_zero(left)) += term;
  }
  value.residual.array() -= 1.0;
}

}  // namespace beamid::experiments
