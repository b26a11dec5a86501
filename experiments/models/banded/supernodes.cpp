#include "experiments/models/banded/supernodes.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <numeric>

namespace beamid::experiments::banded {
namespace {

using Columns = std::vector<std::vector<int>>;

// Coordinates in the order of their elimination.
std::vector<int> elimination_order(const SymmetricPattern& pattern) {
  const auto n = static_cast<int>(pattern.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i)
    for (int k = pattern.start(i); k < pattern.start(i + 1); ++k)
      entries.emplace_back(i, pattern.column(k), 1.0);
  Eigen::SparseMatrix<double> lower(n, n);
  lower.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> found;
  Eigen::AMDOrdering<int>()(lower, found);
  return {found.indices().data(), found.indices().data() + n};
}

// Rows below the diagonal of each column of L, ascending, all counted in the order of elimination.
Columns filled_columns(const SymmetricPattern& pattern, const std::vector<int>& order) {
  const auto n = static_cast<int>(order.size());
  std::vector<int> place(order.size());
  for (int k = 0; k < n; ++k) place[order[k]] = k;
  Columns columns(order.size()), children(order.size());
  for (int i = 0; i < n; ++i)
    for (int k = pattern.start(i); k < pattern.start(i + 1); ++k) {
      const int a = place[i], b = place[pattern.column(k)];
      if (a != b) columns[std::min(a, b)].push_back(std::max(a, b));
    }
  std::vector<int> seen_by(order.size(), -1);
  for (int j = 0; j < n; ++j) {
    seen_by[j] = j;
    std::vector<int> rows;
    const auto take = [&](const std::vector<int>& more) {
      for (const int i : more)
        if (seen_by[i] != j) seen_by[i] = j, rows.push_back(i);
    };
    take(columns[j]);
    for (const int child : children[j]) take(columns[child]);
    std::sort(rows.begin(), rows.end());
    if (!rows.empty()) children[rows.front()].push_back(j);
    columns[j] = std::move(rows);
  }
  return columns;
}

}  // namespace

std::vector<Supernode> supernodes(const SymmetricPattern& pattern, int widest) {
  const std::vector<int> order = elimination_order(pattern);
  const Columns columns = filled_columns(pattern, order);
  // Each column follows at most one of those whose first row it is, and with the same rows below.
  std::vector<int> before(order.size(), -1), width(order.size(), 1);
  std::vector<bool> goes_on(order.size(), false);
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (columns[j].empty()) continue;
    const int next = columns[j].front();
    if (before[next] >= 0 || width[j] == widest || columns[j].size() != columns[next].size() + 1) continue;
    before[next] = static_cast<int>(j);
    width[next] = width[j] + 1;
    goes_on[j] = true;
  }
  std::vector<Supernode> found;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (goes_on[j]) continue;
    Supernode node;
    node.columns = width[j];
    for (int k = static_cast<int>(j); k >= 0; k = before[k]) node.rows.push_back(order[k]);
    std::reverse(node.rows.begin(), node.rows.end());
    for (const int i : columns[j]) node.rows.push_back(order[i]);
    found.push_back(std::move(node));
  }
  return found;
}

}  // namespace beamid::experiments::banded
