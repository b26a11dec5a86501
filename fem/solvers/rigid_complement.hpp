// Everything but rigid-body motion.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "fem/stiffness_solver.hpp"
#include "fem/structural_system.hpp"

namespace beamid::fem {

// A sparse matrix whose rows are mostly alike.

/// Rows that hold the same values at the same places relative to themselves are kept once. A uniform mesh
/// repeats a few rows for all its elements, so that what is left to read per row is one number: products and
/// sweeps along such a matrix are limited by memory, and take a fraction of the time of general sparse
/// storage.
class RepeatedRows {
 public:
  struct Entry {
    int offset = 0;  ///< column minus the row's own place
    double value = 0.0;
  };

  RepeatedRows() = default;

  /// All rows of a symmetric matrix, each placed at its diagonal.
  explicit RepeatedRows(const Eigen::SparseMatrix<double>& symmetric);

  /// Appends one.
  void add(const std::vector<Entry>& row);

  Eigen::Index size() const { return static_cast<Eigen::Index>(kind_.size()); }
  const Entry* begin(Eigen::Index row) const { return entries_.data() + first_[kind_[row]]; }
  const Entry* end(Eigen::Index row) const { return entries_.data() + first_[kind_[row] + 1]; }

  /// Row times x, the row being placed at x[place].
  double product(Eigen::Index row, const double* x_at_place) const {
    double sum = 0.0;
    for (const Entry *entry = begin(row), *last = end(row); entry != last; ++entry)
      sum += entry->value * x_at_place[entry->offset];
    return sum;
  }

  /// y = A x, every row placed at its own number.
  void multiply(const double* x, double* y) const {
    for (Eigen::Index row = 0; row < size(); ++row) y[row] = product(row, x + row);
  }
  Eigen::VectorXd operator*(const Eigen::VectorXd& x) const {
    Eigen::VectorXd result(size());
    multiply(x.data(), result.data());
    return result;
  }

 private:
  std::vector<std::uint32_t> kind_;      // of each row
  std::vector<std::uint32_t> first_{0};  // entry of each kind
  std::vector<Entry> entries_;
};

/// Rigid-body modes R (n x k, R^T M R = I) and the projections that take them out of motions and loads,
///
///     q - R R^T M q,     f - M R R^T f.
class RigidComplement {
 public:
  /// @param motions basis of the rigid-body motions (n x k).
  /// @throws std::runtime_error when one of them has no mass.
  RigidComplement(const SparseMatrix& mass, Eigen::MatrixXd motions);

  const Eigen::MatrixXd& modes() const { return modes_; }
  Eigen::Index count() const { return modes_.cols(); }

  void project_motion(Eigen::Ref<Eigen::VectorXd> motion) const {
    if (count() > 0) motion.noalias() -= modes_ * (loads_.transpose() * motion).eval();
  }
  void project_load(Eigen::Ref<Eigen::VectorXd> load) const {
    if (count() > 0) load.noalias() -= loads_ * (modes_.transpose() * load).eval();
  }

 private:
  Eigen::MatrixXd modes_, loads_;  // R and M R
};

// A few lowest modes of a large system.

/// Shapes (n x count) of the lowest modes that are not rigid, frequencies ascending: shift-invert Lanczos at
/// shift zero [parlett1998, ch. 13], on K^-1 M in the complement of the rigid-body motions, every vector kept
/// orthogonal to all before it. It is not restarted: the spectrum of a beam's K^-1 M falls like 1/i^4, so
/// that 2 count + 5 steps or so do.
///
/// From one start such a space sees one copy of a repeated frequency only (equal spans between clamps,
/// symmetric frames). A second one, started elsewhere in the complement of what was found, has to prove that
/// nothing lower is left; what it finds is taken in, and the search goes on. Its largest Ritz value is an
/// eigenvalue's to its own error, but which one's shows only once that pair has settled: what the start holds
/// little of comes up late.
///
/// Its Ritz values lie inside the spectrum, so a negative one proves a negative omega^2; where the rigidity
/// is indefinite there are always enough steps to bring out one that is not buried between others.
/// @throws std::runtime_error when it does not converge or a negative omega^2 shows up.
Eigen::MatrixXd lowest_shapes(const StructuralSystem& system, const StiffnessSolver& solver,
                              const RigidComplement& complement, Eigen::Index count);

/// @throws std::runtime_error that says what omega^2 [rad^2/s^2] is negative.
[[noreturn]] void throw_unstable(double square);

}  // namespace beamid::fem
