// A(p) = A_0 + sum_j (p_j - p_0j) A_j by rows.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "experiments/models/banded/sparse_rows.hpp"

namespace beamid::experiments::banded {

class ParametricRows {
 public:
  ParametricRows() = default;  ///< of nothing
  /// @param slopes A_j (a); an empty one is zero
  ParametricRows(const fem::SparseMatrix& reference, const std::vector<const fem::SparseMatrix*>& slopes);

  /// @param change p - p_0 (a)
  void set(const Eigen::VectorXd& change);

  const SparseRows& now() const { return now_; }
  const SparseRows& slope(Eigen::Index j) const { return slopes_[j]; }
  /// Coordinates [first, second) that A_j touches.
  std::pair<Eigen::Index, Eigen::Index> reach(Eigen::Index j) const { return reaches_[j]; }

 private:
  SparseRows reference_, now_;
  std::vector<SparseRows> slopes_;
  std::vector<EntryList> entries_;  // of the slopes in now_
  std::vector<std::pair<Eigen::Index, Eigen::Index>> reaches_;
};

}  // namespace beamid::experiments::banded
