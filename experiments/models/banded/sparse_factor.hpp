// A sparse complex symmetric matrix, factored without pivoting.
#pragma once

#include <vector>

#include "experiments/models/banded/banded_lanes.hpp"
#include "experiments/models/banded/supernodes.hpp"

namespace beamid::experiments::banded {

/// P S P^T = L D L^T for the same S as BandedFactor's, of any structure: what does without exchanges in the
/// order of a band does in any other [higham1998, george2002], so that the order may be one that fills little
/// and where L has entries is known before there are values.
///
/// Each supernode is a dense panel, four rows side by side in registers. Its columns are eliminated, and what
/// they change in the panels of later supernodes is taken off there at once (right-looking), to places known
/// beforehand.
class SparseFactor {
 public:
  explicit SparseFactor(const SymmetricPattern& pattern);

  /// @param entries S on the pattern
  /// @throws std::runtime_error when a pivot is zero or not a number.
  void factor(const std::vector<Complex>& entries);

  /// S x = b in place, b (n).
  void solve(Complex* b) const;
  /// The same for four columns at a time.
  void solve(ComplexLanes* b) const;

  /// Entries of L and D, those included that fill panels up.
  std::size_t stored() const { return panels_.size() * Lanes::count; }
  /// The largest entry that elimination met, pivots included, over the largest of S.
  double growth(const std::vector<Complex>& entries) const;

 private:
  static constexpr int widest = 8;
  struct Panel {
    int columns, rows;    // s, and m with the columns' own
    int first;            // of its values in panels_: row a, column k in lane a % 4 of (a / 4) s + k
    int coordinate;       // where its rows begin in coordinates_
    int pivot;            // where its pivots begin in inverse_
    std::size_t updates;  // where the places that it changes begin in updated_
  };
  friend struct SparseKernels;

  std::vector<Panel> nodes_;
  std::vector<int> coordinates_;
  std::vector<int> places_;   // of the pattern's entries: numbers from the start of panels_
  std::vector<int> updated_;  // likewise, of what each panel changes, column after column
  std::vector<ComplexLanes> panels_;
  std::vector<Complex> inverse_;  // 1 / D
};

}  // namespace beamid::experiments::banded
