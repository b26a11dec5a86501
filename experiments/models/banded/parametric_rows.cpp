#include "experiments/models/banded/parametric_rows.hpp"

#include <algorithm>

namespace beamid::experiments::banded {

using Eigen::Index;

ParametricRows::ParametricRows(const fem::SparseMatrix& reference,
                               const std::vector<const fem::SparseMatrix*>& slopes) {
  fem::SparseMatrix sum = reference;  // with places for all that is added later
  for (const fem::SparseMatrix* slope : slopes)
    if (slope->nonZeros() > 0) sum += 0.0 * *slope;
  reference_ = now_ = SparseRows(sum);
  for (const fem::SparseMatrix* slope : slopes) {
    slopes_.emplace_back(slope->nonZeros() > 0 ? *slope : fem::SparseMatrix(sum.rows(), sum.cols()));
    entries_.push_back(now_.entries_of(*slope));
    Index first = sum.cols(), last = 0;
    for (int j = 0; j < slope->outerSize(); ++j)
      if (slope->col(j).nonZeros() > 0) first = std::min<Index>(first, j), last = j + 1;
    reaches_.emplace_back(std::min(first, last), last);
  }
}

void ParametricRows::set(const Eigen::VectorXd& change) {
  if (std::all_of(entries_.begin(), entries_.end(), [](const EntryList& one) { return one.place.empty(); }))
    return;
  now_.values() = reference_.values();
  for (std::size_t j = 0; j < entries_.size(); ++j)
    entries_[j].add(change[static_cast<Index>(j)], now_.values());
}

}  // namespace beamid::experiments::banded
