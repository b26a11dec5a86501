// A sparse matrix by rows, for products with what moves.
#pragma once

#include <vector>

#include "experiments/models/banded/banded_lanes.hpp"
#include "experiments/models/banded/entry_list.hpp"
#include "fem/structural_system.hpp"

namespace beamid::experiments::banded {

class SparseRows {
 public:
  SparseRows() = default;
  explicit SparseRows(const fem::SparseMatrix& matrix);

  bool is_empty() const { return value_.empty(); }

  /// y = A x and y += factor A x; entries are double, Complex or Lanes.
  template <class Entry>
  void multiply(const Entry* x, Entry* y) const;
  template <class Entry>
  void add_product(const Entry* x, Entry* y, double factor = 1.0) const;

  /// total += x^T A y for four x at a time.
  void add_form(const Lanes* x, const double* y, Lanes& total) const;

  /// The values, row after row, columns ascending, to be changed.
  std::vector<double>& values() { return value_; }
  const std::vector<double>& values() const { return value_; }
  /// The entries of a matrix that has no others, among the values.
  EntryList entries_of(const fem::SparseMatrix& matrix) const;

 private:
  std::vector<int> start_, column_;
  std::vector<double> value_;
};

}  // namespace beamid::experiments::banded
