// The factored matrix of an implicit time step.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fem/structural_system.hpp"

namespace beamid::fem {

// Products with a matrix whose entries lie on few diagonals.

/// A x, diagonal by diagonal: contiguous products of vectors where the matrix is a band, as those of a beam
/// are, several times faster than row by row. Anything else is multiplied as Eigen does.
class DiagonalProduct {
 public:
  explicit DiagonalProduct(const SparseMatrix& a);

  bool is_zero() const { return diagonals_.empty() && rest_.nonZeros() == 0; }

  /// y (rows of A) += A x. y must be another vector than x.
  void add(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;

  /// y (rows of A) -= A x.
  void subtract(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;

 private:
  struct Diagonal {
    Eigen::Index row, column;  ///< of its first entry
    Eigen::VectorXd entries;
  };
  std::vector<Diagonal> diagonals_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> rest_;  ///< all of A, when it is no band
};

// The elastic forces of a motion, with the digits of the strain factors.

/// K q as B^T (D (B q)): the strains of a smooth motion of a fine mesh are small differences, which the
/// entries 0 and
/// +-1 of B take exactly and an assembled K loses. Keeps its work space.
class StrainForce {
 public:
  explicit StrainForce(const StrainFactors& stiffness)
      : strain_(stiffness.strain), rigidity_(stiffness.rigidity), equilibrium_(stiffness.strain.transpose()) {
    strains_.resize(stiffness.strain.rows());
    natural_.resize(stiffness.strain.rows());
  }

  /// force (n) -= K q.
  void subtract(const Eigen::VectorXd& q, Eigen::VectorXd& force) {
    strains_.setZero();
    strain_.add(q, strains_);
    natural_.setZero();
    rigidity_.add(strains_, natural_);
    equilibrium_.subtract(natural_, force);
  }

 private:
  DiagonalProduct strain_, rigidity_, equilibrium_;  // B, D, B^T
  Eigen::VectorXd strains_, natural_;
};

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
