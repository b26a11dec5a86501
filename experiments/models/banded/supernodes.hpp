// What eliminating a sparse symmetric matrix fills, found once for all its values.
#pragma once

#include <vector>

#include "experiments/models/banded/symmetric_pattern.hpp"

namespace beamid::experiments::banded {

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

}  // namespace beamid::experiments::banded
