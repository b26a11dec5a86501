#include "fem/response/symmetric_factor.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <stdexcept>

#include "fem/response/band_factor.hpp"

namespace beamid::fem {

struct SymmetricFactor::Method {
  virtual ~Method() = default;
  virtual void solve(Eigen::VectorXd& b) const = 0;
};

namespace {

using Eigen::Index, Eigen::VectorXd;

template <int width>
class Band final : public SymmetricFactor::Method {
 public:
  Band(const SparseMatrix& a, const std::string& what) : factor_(a, what) {}
  void solve(VectorXd& b) const override { factor_.solve(b); }

 private:
  BandFactor<width> factor_;
};

class Sparse final : public SymmetricFactor::Method {
 public:
  Sparse(const SparseMatrix& a, const std::string& what) : factor_(a) {
    if (factor_.info() != Eigen::Success || !(factor_.vectorD().minCoeff() > 0.0))
      throw std::runtime_error(what + " is not positive definite");
  }
  void solve(VectorXd& b) const override { b = factor_.solve(b); }

 private:
  Eigen::SimplicialLDLT<SparseMatrix> factor_;
};

Index half_bandwidth(const SparseMatrix& a) {
  Index width = 0;
  for (Index column = 0; column < a.outerSize(); ++column)
    for (SparseMatrix::InnerIterator it(a, column); it; ++it)
      if (it.value() != 0.0) width = std::max(width, std::abs(it.row() - column));
  return width;
}

}  // namespace

SymmetricFactor::SymmetricFactor(const SparseMatrix& a, const std::string& what) {
  const Index width = half_bandwidth(a);
  if (width <= 3)
    method_ = std::make_unique<Band<3>>(a, what);
  else if (width <= 8)
    method_ = std::make_unique<Band<8>>(a, what);
  else
    method_ = std::make_unique<Sparse>(a, what);
}
SymmetricFactor::~SymmetricFactor() = default;
SymmetricFactor::SymmetricFactor(SymmetricFactor&&) noexcept = default;

void SymmetricFactor::solve_in_place(VectorXd& b) const {
  method_->solve(b);
}

}  // namespace beamid::fem
