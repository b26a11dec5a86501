#include "experiments/models/banded/symmetric_pattern.hpp"

#include <algorithm>
#include <cmath>

namespace beamid::experiments::banded {

using Eigen::Index;

namespace {

// use(row, column, value) of every entry of the lower triangle that is not zero.
template <class Use>
void visit_lower(const fem::SparseMatrix& matrix, const Use& use) {
  for (int j = 0; j < matrix.outerSize(); ++j)
    for (fem::SparseMatrix::InnerIterator it(matrix, j); it; ++it)
      if (it.row() >= j && it.value() != 0.0) use(static_cast<int>(it.row()), j, it.value());
}

}  // namespace

SymmetricPattern::SymmetricPattern(Index size, const std::vector<const fem::SparseMatrix*>& matrices) {
  std::vector<std::vector<int>> rows(static_cast<std::size_t>(size));
  for (const fem::SparseMatrix* matrix : matrices)
    visit_lower(*matrix, [&](int i, int j, double) { rows[i].push_back(j); });
  start_.push_back(0);
  for (Index i = 0; i < size; ++i) {
    std::vector<int>& row = rows[static_cast<std::size_t>(i)];
    row.push_back(static_cast<int>(i));
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    column_.insert(column_.end(), row.begin(), row.end());
    start_.push_back(static_cast<int>(column_.size()));
  }
}

int SymmetricPattern::half_width() const {
  int width = 0;
  for (Index i = 0; i < size(); ++i) width = std::max(width, static_cast<int>(i) - column(start(i)));
  return width;
}

int SymmetricPattern::entry_at(int row, int column) const {
  const auto first = column_.begin() + start_[row], last = column_.begin() + start_[row + 1];
  return static_cast<int>(std::lower_bound(first, last, column) - column_.begin());
}

std::vector<double> SymmetricPattern::values(const fem::SparseMatrix& matrix) const {
  std::vector<double> result(entries(), 0.0);
  visit_lower(matrix, [&](int i, int j, double value) { result[entry_at(i, j)] = value; });
  return result;
}

EntryList SymmetricPattern::part(const fem::SparseMatrix& matrix) const {
  EntryList result;
  visit_lower(matrix, [&](int i, int j, double value) {
    result.place.push_back(entry_at(i, j));
    result.value.push_back(value);
  });
  return result;
}

fem::SparseMatrix assembled_stiffness(const fem::SparseMatrix& strain, const fem::SparseMatrix& rigidity) {
  constexpr double rounding = 1e-14;
  fem::SparseMatrix matrix = strain.transpose() * rigidity * strain;
  const Eigen::VectorXd size = matrix.diagonal().cwiseAbs().cwiseSqrt();
  matrix.prune([&](Index row, Index column, double value) {
    return row == column || std::abs(value) > rounding * size[row] * size[column];
  });
  return matrix;
}

}  // namespace beamid::experiments::banded
