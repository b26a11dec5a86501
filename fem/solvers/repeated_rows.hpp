// A sparse matrix whose rows are mostly alike.
#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <vector>

namespace beamid::fem {

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

}  // namespace beamid::fem
