#include "filters/nonzeros.hpp"

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd;

bool NonZeros::take(const Eigen::Ref<const MatrixXd>& a) {
  const auto most = static_cast<std::size_t>(a.size() / 4);
  rows_ = a.rows();
  entries_.clear();
  for (Index j = 0; j < a.cols(); ++j)
    for (Index i = 0; i < rows_; ++i) {
      if (a(i, j) == 0.0) continue;
      if (entries_.size() == most) return false;
      entries_.push_back({i, j, a(i, j)});
    }
  return true;
}

void NonZeros::from_right(const MatrixXd& b, MatrixXd& out) const {
  out.setZero(b.rows(), rows_);
  for (const Entry& entry : entries_) out.col(entry.row) += entry.value * b.col(entry.column);
}

void NonZeros::from_left(const MatrixXd& b, MatrixXd& out) const {
  out.setZero(rows_, b.cols());
  for (Index j = 0; j < b.cols(); ++j)
    for (const Entry& entry : entries_) out(entry.row, j) += entry.value * b(entry.column, j);
}

}  // namespace beamid::filters
