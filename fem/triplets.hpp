// Sparse matrices from entries that add up.
#pragma once

#include <vector>

#include "fem/structural_system.hpp"

namespace beamid::fem {

using Triplets = std::vector<Eigen::Triplet<double>>;

/// Entries at the same place are added.
inline SparseMatrix sparse(Eigen::Index rows, Eigen::Index columns, const Triplets& entries) {
  SparseMatrix matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  matrix.makeCompressed();
  return matrix;
}

}  // namespace beamid::fem
