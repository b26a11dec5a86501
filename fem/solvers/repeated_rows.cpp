#include "fem/solvers/repeated_rows.hpp"

#include <algorithm>

namespace beamid::fem {

RepeatedRows::RepeatedRows(const Eigen::SparseMatrix<double>& symmetric) {
  kind_.reserve(static_cast<std::size_t>(symmetric.rows()));
  std::vector<Entry> row;
  for (int k = 0; k < symmetric.outerSize(); ++k) {
    row.clear();
    for (Eigen::SparseMatrix<double>::InnerIterator it(symmetric, k); it; ++it)
      row.push_back({static_cast<int>(it.row()) - k, it.value()});
    add(row);
  }
}

void RepeatedRows::add(const std::vector<Entry>& row) {
  constexpr std::size_t memory = 8;  // a mesh repeats after two or three rows
  const std::size_t kinds = first_.size() - 1;
  const auto same = [](const Entry& a, const Entry& b) { return a.offset == b.offset && a.value == b.value; };
  for (std::size_t kind = kinds; kind > 0 && kind + memory > kinds; --kind)
    if (std::equal(row.begin(), row.end(), entries_.begin() + first_[kind - 1],
                   entries_.begin() + first_[kind], same)) {
      kind_.push_back(static_cast<std::uint32_t>(kind - 1));
      return;
    }
  kind_.push_back(static_cast<std::uint32_t>(kinds));
  entries_.insert(entries_.end(), row.begin(), row.end());
  first_.push_back(static_cast<std::uint32_t>(entries_.size()));
}

}  // namespace beamid::fem
