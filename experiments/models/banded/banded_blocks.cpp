#include "experiments/models/banded/banded_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace beamid::experiments::banded {

using Eigen::Index;

namespace {

using std::numbers::sqrt3;
using Vector = Lanes::Vector;

[[gnu::always_inline]] inline void transpose(Vector& a, Vector& b, Vector& c, Vector& d) {
  const Vector ab = __builtin_shufflevector(a, b, 0, 4, 2, 6), ba = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Vector cd = __builtin_shufflevector(c, d, 0, 4, 2, 6), dc = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
  b = __builtin_shufflevector(ba, dc, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
  d = __builtin_shufflevector(ba, dc, 2, 3, 6, 7);
}

[[gnu::always_inline]] inline void add_rows(Vector* rows, double* const* columns, Index at) {
  transpose(rows[0], rows[1], rows[2], rows[3]);
#pragma GCC unroll 4
  for (int k = 0; k < Lanes::count; ++k) {
    Vector value;
    std::memcpy(&value, columns[k] + at, sizeof value);
    value += rows[k];
    std::memcpy(columns[k] + at, &value, sizeof value);
  }
}

// Several at a time: what is added to is read and written once.
template <int count>
[[gnu::always_inline]] inline void add_some(const double* const* g, const ComplexLanes* factors, Index size,
                                            ComplexLanes* right) {
  ComplexLanes by[count];
  for (int k = 0; k < count; ++k) by[k] = factors[k];
  for (Index i = 0; i < size; ++i) {
    ComplexLanes sum = right[i];
#pragma GCC unroll 4
    for (int k = 0; k < count; ++k) sum += g[k][i] * by[k];
    right[i] = sum;
  }
}

}  // namespace

BEAMID_WIDE_CLONE void gather(const double* const* columns, Index size, Lanes* block) {
  Index i = 0;
  for (; i + Lanes::count <= size; i += Lanes::count) {
    Vector part[Lanes::count];
#pragma GCC unroll 4
    for (int k = 0; k < Lanes::count; ++k) std::memcpy(&part[k], columns[k] + i, sizeof(Vector));
    transpose(part[0], part[1], part[2], part[3]);
#pragma GCC unroll 4
    for (int k = 0; k < Lanes::count; ++k) block[i + k].values = part[k];
  }
  for (; i < size; ++i)
    for (int k = 0; k < Lanes::count; ++k) block[i].values[k] = columns[k][i];
}

BEAMID_WIDE_CLONE void right_side(const Lanes* stiff, const Lanes* momentum, double interval, Index size,
                                  ComplexLanes* right) {
  const double real = -3.0 / interval, imaginary = -sqrt3 / interval;
  for (Index i = 0; i < size; ++i) {
    right[i].re = stiff[i] + real * momentum[i];
    right[i].im = imaginary * momentum[i];
  }
}

BEAMID_WIDE_CLONE void add_forcing(const Complex* forcing, const Lanes& part, Index first, Index last,
                                   ComplexLanes* right) {
  const Lanes factor = part;
  for (Index i = first; i < last; ++i) {
    right[i].re += forcing[i].re * factor;
    right[i].im += forcing[i].im * factor;
  }
}

BEAMID_WIDE_CLONE void add_multiples(const double* const* g, const ComplexLanes* factors, int count,
                                     Index size, ComplexLanes* right) {
  if (count >= 3) {
    add_some<3>(g, factors, size, right);
    return add_multiples(g + 3, factors + 3, count - 3, size, right);
  }
  if (count == 2) add_some<2>(g, factors, size, right);
  if (count == 1) add_some<1>(g, factors, size, right);
}

BEAMID_WIDE_CLONE void scatter(const ComplexLanes* change, double interval, Index size,
                               double* const* columns, double* const* rates) {
  const double step = 4.0 * sqrt3, pace = 12.0 / interval;
  Index i = 0;
  for (; i + Lanes::count <= size; i += Lanes::count) {
    Vector rows[Lanes::count], rate_rows[Lanes::count];
#pragma GCC unroll 4
    for (int k = 0; k < Lanes::count; ++k) {
      const ComplexLanes& d = change[i + k];
      rows[k] = step * d.im.values;
      rate_rows[k] = pace * (d.re.values + sqrt3 * d.im.values);
    }
    add_rows(rows, columns, i);
    add_rows(rate_rows, rates, i);
  }
  for (; i < size; ++i)
    for (int k = 0; k < Lanes::count; ++k) {
      columns[k][i] += step * change[i].im.values[k];
      rates[k][i] += pace * (change[i].re.values[k] + sqrt3 * change[i].im.values[k]);
    }
}

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
