// The factored matrix of an implicit time step.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "fem/structural_system.hpp"

namespace beamid::fem {

/// Solves A x = b for a symmetric positive definite A, many times. A narrow band, which is what node after
/// node of a beam gives, is factored as L D L^T in its own order and stored as such; anything wider by
/// Eigen's sparse Cholesky, reordered.
class SymmetricFactor {
 public:
  /// @param what A is called in the message, @throws std::runtime_error when A is not positive definite.
  SymmetricFactor(const SparseMatrix& a, const std::string& what);
  ~SymmetricFactor();
  SymmetricFactor(SymmetricFactor&&) noexcept;

  /// b (n) becomes A^-1 b.
  void solve_in_place(Eigen::VectorXd& b) const;

  struct Method;

 private:
  std::unique_ptr<Method> method_;
};

}  // namespace beamid::fem
