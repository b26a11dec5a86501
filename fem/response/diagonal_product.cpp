#include "fem/response/diagonal_product.hpp"

#include <algorithm>
#include <map>

namespace beamid::fem {

using Eigen::Index, Eigen::VectorXd;

DiagonalProduct::DiagonalProduct(const SparseMatrix& a) {
  struct Range {
    Index first, last;  // columns
  };
  std::map<Index, Range> ranges;  // by column - row
  for (Index column = 0; column < a.cols(); ++column)
    for (SparseMatrix::InnerIterator it(a, column); it; ++it) {
      if (it.value() == 0.0) continue;
      const auto [range, is_new] = ranges.try_emplace(column - it.row(), Range{column, column});
      range->second.last = column;
    }
  Index stored = 0;
  for (const auto& [offset, range] : ranges) stored += range.last - range.first + 1;
  if (stored > 3 * a.nonZeros()) {  // the zeros in between would take longer than they save
    rest_ = a;
    return;
  }
  std::map<Index, std::size_t> place;
  for (const auto& [offset, range] : ranges) {
    place[offset] = diagonals_.size();
    diagonals_.push_back({range.first - offset, range.first, VectorXd::Zero(range.last - range.first + 1)});
  }
  for (Index column = 0; column < a.cols(); ++column)
    for (SparseMatrix::InnerIterator it(a, column); it; ++it)
      if (it.value() != 0.0) {
        Diagonal& diagonal = diagonals_[place[column - it.row()]];
        diagonal.entries[column - diagonal.column] = it.value();
      }
}

void DiagonalProduct::add(const VectorXd& x, VectorXd& y) const {
  for (const auto& [row, column, entries] : diagonals_)
    y.segment(row, entries.size()) += entries.cwiseProduct(x.segment(column, entries.size()));
  if (rest_.nonZeros() > 0) y.noalias() += rest_ * x;
}

void DiagonalProduct::subtract(const VectorXd& x, VectorXd& y) const {
  for (const auto& [row, column, entries] : diagonals_)
    y.segment(row, entries.size()) -= entries.cwiseProduct(x.segment(column, entries.size()));
  if (rest_.nonZeros() > 0) y.noalias() -= rest_ * x;
}

}  // namespace beamid::fem
