#include "experiments/models/banded/sparse_rows.hpp"

#include <algorithm>

namespace beamid::experiments::banded {
namespace {

// use(i, (A x)_i) of every row.
template <class Entry, class Use>
[[gnu::always_inline]] inline void multiply_rows(const std::vector<int>& start, const int* column,
                                                 const double* value, const Entry* x, const Use& use) {
  for (std::size_t i = 0; i + 1 < start.size(); ++i) {
    Entry sum{};
    for (int k = start[i]; k < start[i + 1]; ++k) sum += value[k] * x[column[k]];
    use(i, sum);
  }
}

BEAMID_WIDE_CLONE void set_rows(const std::vector<int>& start, const int* column, const double* value,
                                const Lanes* x, Lanes* y) {
  multiply_rows(start, column, value, x, [y](std::size_t i, const Lanes& sum) { y[i] = sum; });
}
template <class Entry>
void set_rows(const std::vector<int>& start, const int* column, const double* value, const Entry* x,
              Entry* y) {
  multiply_rows(start, column, value, x, [y](std::size_t i, const Entry& sum) { y[i] = sum; });
}

BEAMID_WIDE_CLONE void add_rows(const std::vector<int>& start, const int* column, const double* value,
                                const Lanes* x, Lanes* y, double factor) {
  multiply_rows(start, column, value, x,
                [y, factor](std::size_t i, const Lanes& sum) { y[i] += factor * sum; });
}
template <class Entry>
void add_rows(const std::vector<int>& start, const int* column, const double* value, const Entry* x, Entry* y,
              double factor) {
  multiply_rows(start, column, value, x,
                [y, factor](std::size_t i, const Entry& sum) { y[i] += factor * sum; });
}

}  // namespace

SparseRows::SparseRows(const fem::SparseMatrix& matrix) {
  const Eigen::SparseMatrix<double, Eigen::RowMajor> rows = matrix;
  start_.assign(rows.outerIndexPtr(), rows.outerIndexPtr() + rows.rows() + 1);
  column_.assign(rows.innerIndexPtr(), rows.innerIndexPtr() + rows.nonZeros());
  value_.assign(rows.valuePtr(), rows.valuePtr() + rows.nonZeros());
}

template <class Entry>
void SparseRows::multiply(const Entry* x, Entry* y) const {
  set_rows(start_, column_.data(), value_.data(), x, y);
}
template <class Entry>
void SparseRows::add_product(const Entry* x, Entry* y, double factor) const {
  if (is_empty()) return;
  add_rows(start_, column_.data(), value_.data(), x, y, factor);
}
template void SparseRows::multiply(const double* x, double* y) const;
template void SparseRows::multiply(const Complex* x, Complex* y) const;
template void SparseRows::multiply(const Lanes* x, Lanes* y) const;
template void SparseRows::add_product(const double* x, double* y, double factor) const;
template void SparseRows::add_product(const Complex* x, Complex* y, double factor) const;
template void SparseRows::add_product(const Lanes* x, Lanes* y, double factor) const;

void SparseRows::add_form(const Lanes* x, const double* y, Lanes& total) const {
  if (is_empty()) return;
  multiply_rows(start_, column_.data(), value_.data(), y,
                [x, &total](std::size_t i, double sum) { total += sum * x[i]; });
}

EntryList SparseRows::entries_of(const fem::SparseMatrix& matrix) const {
  EntryList entries;
  for (int j = 0; j < matrix.outerSize(); ++j)
    for (fem::SparseMatrix::InnerIterator it(matrix, j); it; ++it) {
      const auto first = column_.begin() + start_[it.row()], last = column_.begin() + start_[it.row() + 1];
      entries.place.push_back(static_cast<int>(std::lower_bound(first, last, j) - column_.begin()));
      entries.value.push_back(it.value());
    }
  return entries;
}

}  // namespace beamid::experiments::banded
