#include "experiments/models/banded/banded_stiffness.hpp"

#include <algorithm>

#include "experiments/models/banded/symmetric_pattern.hpp"

namespace beamid::experiments::banded {

using Eigen::Index;

namespace {

// First strain of each block: where no entry of any of the matrices reaches across. The last is the number of
// strains.
std::vector<int> block_starts(const std::vector<const fem::SparseMatrix*>& rigidities) {
  const auto strains = static_cast<int>(rigidities.empty() ? 0 : rigidities.front()->rows());
  std::vector<int> last(strains);  // strain that each is coupled to
  for (int i = 0; i < strains; ++i) last[i] = i;
  for (const fem::SparseMatrix* matrix : rigidities)
    for (int j = 0; j < matrix->outerSize(); ++j)
      for (fem::SparseMatrix::InnerIterator it(*matrix, j); it; ++it) {
        const int low = std::min(static_cast<int>(it.row()), j);
        last[low] = std::max({last[low], static_cast<int>(it.row()), j});
      }
  std::vector<int> starts;
  for (int i = 0, end = -1; i < strains; ++i) {
    if (i > end) starts.push_back(i);
    end = std::max(end, last[i]);
  }
  starts.push_back(strains);
  return starts;
}

int largest_block(const std::vector<int>& starts) {
  int largest = 0;
  for (std::size_t b = 0; b + 1 < starts.size(); ++b) largest = std::max(largest, starts[b + 1] - starts[b]);
  return largest;
}

bool are_equal(const fem::SparseMatrix& a, const fem::SparseMatrix& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && (a - b).squaredNorm() == 0.0;
}

}  // namespace

BandedStiffness::BandedStiffness(const fem::ParametricSystem& equations) {
  const fem::StrainFactors& own = equations.system.stiffness;
  std::vector<const fem::SparseMatrix*> rigidities;
  for (const auto& slope : equations.derivatives) rigidities.push_back(&slope.rigidity);
  const bool shared = rigidities.empty() || are_equal(equations.strain, own.strain);
  if (shared) rigidities.push_back(&own.rigidity);
  const std::vector<int> starts = block_starts(rigidities);
  const std::vector<int> own_starts = shared ? starts : block_starts({&own.rigidity});
  const bool small =
      std::max(largest_block(starts), largest_block(own_starts)) <= StrainProduct::largest_block;
  form_ = !small ? Form::rows : shared ? Form::one_set_of_strains : Form::two_sets;
  if (form_ == Form::rows)
    take_rows(equations);
  else
    take_strains(equations, own_starts, starts);
}

void BandedStiffness::take_strains(const fem::ParametricSystem& equations, const std::vector<int>& own_starts,
                                   const std::vector<int>& starts) {
  const fem::StrainFactors& own = equations.system.stiffness;
  fem::SparseMatrix rigidity = own.rigidity;  // with places for what is added later
  if (form_ == Form::one_set_of_strains)
    for (const auto& slope : equations.derivatives) rigidity += 0.0 * slope.rigidity;
  reference_ = StrainProduct(own.strain, rigidity, own_starts);
  for (const auto& slope : equations.derivatives)
    slopes_.emplace_back(equations.strain, slope.rigidity, starts);
  current_ = {reference_};
  if (form_ == Form::two_sets) current_.insert(current_.end(), slopes_.begin(), slopes_.end());
  set(Eigen::VectorXd::Zero(static_cast<Index>(slopes_.size())));
}

void BandedStiffness::take_rows(const fem::ParametricSystem& equations) {
  const fem::StrainFactors& own = equations.system.stiffness;
  std::vector<fem::SparseMatrix> slopes;
  std::vector<const fem::SparseMatrix*> all;
  for (const auto& slope : equations.derivatives)
    slopes.push_back(assembled_stiffness(equations.strain, slope.rigidity));
  for (const fem::SparseMatrix& slope : slopes) all.push_back(&slope);
  rows_ = ParametricRows(assembled_stiffness(own.strain, own.rigidity), all);
}

void BandedStiffness::set(const Eigen::VectorXd& change) {
  if (form_ == Form::rows) return rows_.set(change);
  current_[0].take_rigidity(reference_);
  for (std::size_t j = 0; j < slopes_.size(); ++j) {
    const double by = change[static_cast<Index>(j)];
    if (form_ == Form::one_set_of_strains) {
      if (by != 0.0) current_[0].add(by, slopes_[j]);
      continue;
    }
    current_[j + 1].take_rigidity(slopes_[j]);
    current_[j + 1].add(by - 1.0, slopes_[j]);  // D_j + (change_j - 1) D_j
  }
}

}  // namespace beamid::experiments::banded
