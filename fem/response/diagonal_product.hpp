// Products with a matrix whose entries lie on few diagonals.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/structural_system.hpp"

namespace beamid::fem {

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

}  // namespace beamid::fem
