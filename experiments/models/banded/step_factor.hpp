// S of a step, factored in the storage that suits its structure.
#pragma once

#include <variant>
#include <vector>

#include "experiments/models/banded/banded_blocks.hpp"
#include "experiments/models/banded/banded_factor.hpp"
#include "experiments/models/banded/banded_lanes.hpp"

namespace beamid::experiments::banded {

// What eliminating a sparse symmetric matrix fills, found once for all its values.

/// Columns of L that have their entries in the same rows below them, eliminated together.
struct Supernode {
  int columns = 0;
  /// Coordinates: first the columns' own, then those of the rows below, in the order of elimination.
  std::vector<int> rows;
};

/// An order that fills little (approximate minimum degree [amestoy1996]) and the columns of L in it, by the
/// elimination tree [liu1990]: the rows of a column are those of the matrix and of the columns whose first
/// row below the diagonal it is.
/// @return in the order of elimination, none with more than `widest` columns
std::vector<Supernode> supernodes(const SymmetricPattern& pattern, int widest);

// A sparse complex symmetric matrix, factored without pivoting.

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

/// L D L^T of a complex symmetric matrix with positive definite imaginary part: a band where node follows
/// node as along a beam (narrow_band), else sparse.
class StepFactor {
 public:
  explicit StepFactor(const SymmetricPattern& pattern);

  bool is_band() const { return std::holds_alternative<Band>(kind_); }

  /// @param entries S on the pattern
  /// @throws std::runtime_error when a pivot is zero or not a number.
  void factor(const std::vector<Complex>& entries);
  void solve(Complex* b) const;       ///< S x = b in place, b (n)
  void solve(ComplexLanes* b) const;  ///< the same for four columns at a time
  /// The real part of S^-1 b, b real (n).
  Eigen::VectorXd real_part_solved(const Eigen::VectorXd& b) const;
  /// The largest entry that elimination met over the largest of S.
  double growth(const std::vector<Complex>& entries) const;

 private:
  struct Band {
    BandedFactor factor;
    std::vector<std::size_t> places;  // of the pattern's entries
  };
  static std::variant<Band, SparseFactor> made_for(const SymmetricPattern& pattern);

  std::variant<Band, SparseFactor> kind_;
};

}  // namespace beamid::experiments::banded
