// Entries of symmetric banded matrices, four directions at a time.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "experiments/models/banded/banded_lanes.hpp"
#include "fem/structural_system.hpp"

namespace beamid::experiments::banded {

/// Row i of four columns (n each) into block[i].
void gather(const double* const* columns, Eigen::Index size, Lanes* block);

/// K q - lambda M q' (n) from K q and M q', lambda = (3 + i sqrt 3) / dt.
void right_side(const Lanes* stiff, const Lanes* momentum, double interval, Eigen::Index size,
                ComplexLanes* right);

/// right += forcing times each direction's part of it, in the rows [first, last).
void add_forcing(const Complex* forcing, const Lanes& part, Eigen::Index first, Eigen::Index last,
                 ComplexLanes* right);

/// right += sum_i factor_i g_i, of `count` vectors g_i (n) with a factor of each direction.
void add_multiples(const double* const* g, const ComplexLanes* factors, int count, Eigen::Index size,
                   ComplexLanes* right);

/// What the solution d (n) adds to q and q', into four columns each: 4 sqrt3 Im d and
/// (12 / dt) (Re d + sqrt3 Im d).
void scatter(const ComplexLanes* change, double interval, Eigen::Index size, double* const* columns,
             double* const* rates);

// Where symmetric matrices that are added up have entries.

// A few numbers of an array, and where they stand in it.

/// The entries of one matrix among those of a sum.
struct EntryList {
  std::vector<int> place;
  std::vector<double> value;

  /// sum += factor times this
  void add(double factor, std::vector<double>& sum) const {
    for (std::size_t k = 0; k < place.size(); ++k) sum[place[k]] += factor * value[k];
  }
};

/// Entries beside the diagonal up to which a band is kept as one: its loops, without indices, take less time
/// per entry than those of a sparse matrix, and a wider one is mostly zeros.
inline constexpr int narrow_band = 8;

/// The lower triangle of the union of several matrices (n x n): row after row, columns ascending, with every
/// diagonal entry. Entries are numbered in this order, so that sums of the matrices are sums of arrays.
class SymmetricPattern {
 public:
  SymmetricPattern(Eigen::Index size, const std::vector<const fem::SparseMatrix*>& matrices);

  Eigen::Index size() const { return static_cast<Eigen::Index>(start_.size()) - 1; }  ///< n
  std::size_t entries() const { return column_.size(); }
  int start(Eigen::Index row) const { return start_[static_cast<std::size_t>(row)]; }  ///< its first entry
  int column(int entry) const { return column_[static_cast<std::size_t>(entry)]; }
  /// The most places between the diagonal and an entry.
  int half_width() const;

  /// The lower triangle of a matrix that has no other entries (entries); zero where it has none.
  std::vector<double> values(const fem::SparseMatrix& matrix) const;

  /// Those that one matrix has.
  EntryList part(const fem::SparseMatrix& matrix) const;

 private:
  std::vector<int> start_, column_;  // n + 1; entries

  int entry_at(int row, int column) const;
};

/// B^T D B (n x n) without entries that rounding alone has left: those below 1e-14 of the two diagonal ones,
/// which would be taken for coupling.
fem::SparseMatrix assembled_stiffness(const fem::SparseMatrix& strain, const fem::SparseMatrix& rigidity);

}  // namespace beamid::experiments::banded
