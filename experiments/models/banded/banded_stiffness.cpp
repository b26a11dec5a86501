#include "experiments/models/banded/banded_stiffness.hpp"

#include <algorithm>

namespace beamid::experiments::banded {

using Eigen::Index;

namespace {

// First strain of each block: where no entry of any D reaches across. The last is the number of strains.
std::vector<int> block_starts(const fem::ParametricSystem& equations) {
  const auto strains = static_cast<int>(equations.system.stiffness.rigidity.rows());
  std::vector<int> last(strains);  // strain that each is coupled to
  for (int i = 0; i < strains; ++i) last[i] = i;
  const auto note = [&](const fem::SparseMatrix& matrix) {
    for (int j = 0; j < matrix.outerSize(); ++j)
      for (fem::SparseMatrix::InnerIterator it(matrix, j); it; ++it) {
        const int low = std::min(static_cast<int>(it.row()), j);
        last[low] = std::max({last[low], static_cast<int>(it.row()), j});
      }
  };
  note(equations.system.stiffness.rigidity);
  for (const auto& slope : equations.derivatives) note(slope.rigidity);
  std::vector<int> starts;
  for (int i = 0, end = -1; i < strains; ++i) {
    if (i > end) starts.push_back(i);
    end = std::max(end, last[i]);
  }
  starts.push_back(strains);
  return starts;
}

// D with the entries that any D_j has, zero where D itself has none: what is added later finds its place.
fem::SparseMatrix with_all_places(const fem::ParametricSystem& equations) {
  fem::SparseMatrix matrix = equations.system.stiffness.rigidity;
  for (const auto& slope : equations.derivatives) matrix += 0.0 * slope.rigidity;
  return matrix;
}

}  // namespace

BandedStiffness::BandedStiffness(const fem::ParametricSystem& equations)
    : reference_(equations.system.stiffness.strain, with_all_places(equations), block_starts(equations)),
      current_(reference_) {
  const std::vector<int> starts = block_starts(equations);
  for (const auto& slope : equations.derivatives)
    slopes_.emplace_back(equations.system.stiffness.strain, slope.rigidity, starts);
}

void BandedStiffness::set(const Eigen::VectorXd& change) {
  current_.take_rigidity(reference_);
  for (std::size_t j = 0; j < slopes_.size(); ++j)
    if (change[static_cast<Index>(j)] != 0.0) current_.add(change[static_cast<Index>(j)], slopes_[j]);
}

}  // namespace beamid::experiments::banded
