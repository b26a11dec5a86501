// Shapes made orthonormal with respect to mass.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "fem/structural_system.hpp"

namespace beamid::reduction {

/// Columns V (n x r), V^T M V = I, by Gram and Schmidt, each against all before it and twice.
class OrthonormalBasis {
 public:
  /// @param mass M (n x n), which must outlive the basis
  explicit OrthonormalBasis(const fem::SparseMatrix& mass) : mass_(mass), columns_(mass.rows(), 0) {}
  /// @param columns (n x k), orthonormal, that it begins with
  OrthonormalBasis(const fem::SparseMatrix& mass, Eigen::MatrixXd columns)
      : mass_(mass), columns_(std::move(columns)) {}

  /// Appends what `shape` (n) adds, unless that is less than `dependent` of it, or has no mass.
  /// @returns whether something was added.
  bool add(const Eigen::VectorXd& shape) {
    const double length = norm(shape);
    if (!(length > 0.0) || columns_.cols() >= mass_.rows()) return false;
    Eigen::VectorXd rest = shape / length;
    for (int pass = 0; pass < 2; ++pass) rest -= columns_ * (columns_.transpose() * (mass_ * rest)).eval();
    const double left = norm(rest);
    if (!(left > dependent)) return false;
    rest /= left;
    rest -= columns_ * (columns_.transpose() * (mass_ * rest)).eval();
    columns_.conservativeResize(Eigen::NoChange, columns_.cols() + 1);
    columns_.rightCols<1>() = rest / norm(rest);
    return true;
  }

  void add_all(const Eigen::MatrixXd& shapes) {
    for (Eigen::Index i = 0; i < shapes.cols(); ++i) add(shapes.col(i));
  }

  const Eigen::MatrixXd& columns() const { return columns_; }

 private:
  static constexpr double dependent = 1e-11;
  const fem::SparseMatrix& mass_;
  Eigen::MatrixXd columns_;

  double norm(const Eigen::VectorXd& shape) const {
    return std::sqrt(std::max(0.0, shape.dot(mass_ * shape)));
  }
};

}  // namespace beamid::reduction
