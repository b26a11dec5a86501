// A complex symmetric band, factored without pivoting.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/models/banded/banded_lanes.hpp"

namespace beamid::experiments::banded {

/// L D L^T = S, S complex symmetric with w entries beside the diagonal, for
///
///     S = K + lambda C + lambda^2 M,   lambda = (3 + i sqrt 3) / dt
///
/// The imaginary part of S is positive definite, and so is its real part unless an axial load buckles the
/// beam. For such matrices no entry grows beyond three times the largest while they are eliminated in any
/// order [higham1998, george2002]: none is exchanged, and the band keeps its width.
class BandedFactor {
 public:
  /// @throws std::invalid_argument when the band is wider than `widest`.
  BandedFactor(Eigen::Index size, int width);
  static constexpr int widest = 32;

  /// Entries beside the diagonal that rows have, the band's own and some zeros.
  int width() const { return width_; }

  /// The lower triangle to be factored: row i holds S(i, i - width()) ... S(i, i); columns before the first
  /// stay zero. factor() replaces it.
  Complex* row(Eigen::Index i) { return &rows_[static_cast<std::size_t>(i) * (width_ + 1)]; }

  /// The lower triangle from its entries; the rest of the rows becomes zero.
  /// @param places of the entries, row(i)[k] being at i (width() + 1) + k
  void fill(const std::vector<Complex>& entries, const std::vector<std::size_t>& places);

  /// @throws std::runtime_error when a pivot is zero or not a number.
  void factor();

  /// S x = b in place, b (n).
  void solve(Complex* b) const;
  /// The same for four columns at a time.
  void solve(ComplexLanes* b) const;

  /// S as it was before factor(), for growth().
  const std::vector<Complex>& rows() const { return rows_; }
  /// The largest entry that elimination met, pivots included, over the largest of S as rows() gave it.
  double growth(const std::vector<Complex>& unfactored) const;

 private:
  template <class Entry>
  void solve_any(const Complex* rows, Entry* b) const;

  Eigen::Index size_;
  int width_;
  std::vector<Complex> rows_;  // S, then L beside the diagonal and 1 / D on it
};

}  // namespace beamid::experiments::banded
