#include "experiments/models/banded/step_factor.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

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

namespace {

constexpr int lanes = Lanes::count;
constexpr int numbers = 2 * lanes;  // of a ComplexLanes: real parts, then imaginary ones

int groups_of(int rows) {
  return (rows + lanes - 1) / lanes;
}

// Numbers from the start of a panel of s columns to the real part at row a, column k.
constexpr int place_in_panel(int a, int k, int s) {
  return (a / lanes * s + k) * numbers + a % lanes;
}

[[gnu::always_inline]] inline Complex entry(const double* panel, int a, int k, int s) {
  const double* const at = panel + place_in_panel(a, k, s);
  return {at[0], at[lanes]};
}

double magnitude_of(const Complex& z) {
  return std::hypot(z.re, z.im);
}

}  // namespace

// The loops over panels, for each number of columns s, in both widths of registers.
struct SparseKernels {
  // L in the place of the panel, 1 / D; then L D L^T of the rows below off the panels that have them.
  template <int s>
  [[gnu::always_inline]] static inline void eliminate(ComplexLanes* panel, int rows, Complex* inverses,
                                                      const int* updated, double* all) {
    const int groups = groups_of(rows);
    auto* const numbers_of_panel = reinterpret_cast<double*>(panel);
    Complex pivots[s];
    for (int k = 0; k < s; ++k) {
      Complex across[s];
      for (int c = k + 1; c < s; ++c) across[c] = entry(numbers_of_panel, c, k, s);
      pivots[k] = entry(numbers_of_panel, k, k, s);
      inverses[k] = inverse(pivots[k]);
      for (int g = k / lanes; g < groups; ++g) {
        const ComplexLanes column = inverses[k] * panel[g * s + k];
        panel[g * s + k] = column;
        for (int c = k + 1; c < s; ++c) panel[g * s + c] -= across[c] * column;
      }
    }
    for (int b = s; b < rows; ++b) {
      Complex weight[s];
      for (int k = 0; k < s; ++k) weight[k] = pivots[k] * entry(numbers_of_panel, b, k, s);
      for (int g = b / lanes; g < groups; ++g) {
        ComplexLanes change = weight[0] * panel[g * s];
        for (int k = 1; k < s; ++k) change += weight[k] * panel[g * s + k];
        const int end = std::min(lanes, rows - lanes * g);
        for (int l = std::max(0, b - lanes * g); l < end; ++l) {
          double* const at = all + *updated++;
          at[0] -= change.re.values[l];
          at[lanes] -= change.im.values[l];
        }
      }
    }
  }

  template <int s, class Real>
  [[gnu::always_inline]] static inline void forward(const double* panel, int rows, const Complex* inverses,
                                                    const int* at, ComplexOf<Real>* b) {
    ComplexOf<Real> x[s];
#pragma GCC unroll 8
    for (int k = 0; k < s; ++k) {
      x[k] = b[at[k]];
#pragma GCC unroll 8
      for (int c = 0; c < k; ++c) x[k] -= entry(panel, k, c, s) * x[c];
      b[at[k]] = inverses[k] * x[k];
    }
    for (int a = s; a < rows; ++a) {
      ComplexOf<Real> value = b[at[a]];
#pragma GCC unroll 8
      for (int k = 0; k < s; ++k) value -= entry(panel, a, k, s) * x[k];
      b[at[a]] = value;
    }
  }

  template <int s, class Real>
  [[gnu::always_inline]] static inline void backward(const double* panel, int rows, const int* at,
                                                     ComplexOf<Real>* b) {
    ComplexOf<Real> x[s];
#pragma GCC unroll 8
    for (int k = 0; k < s; ++k) x[k] = b[at[k]];
    for (int a = s; a < rows; ++a) {
      const ComplexOf<Real> below = b[at[a]];
#pragma GCC unroll 8
      for (int k = 0; k < s; ++k) x[k] -= entry(panel, a, k, s) * below;
    }
#pragma GCC unroll 8
    for (int k = s - 1; k >= 0; --k) {
#pragma GCC unroll 8
      for (int c = k + 1; c < s; ++c) x[k] -= entry(panel, c, k, s) * x[c];
      b[at[k]] = x[k];
    }
  }

  // work(std::integral_constant<int, s>) for the number of columns that a panel has.
  template <class Work>
  [[gnu::always_inline]] static inline void for_columns(int s, const Work& work) {
    switch (s) {
      case 1:
        return work(std::integral_constant<int, 1>{});
      case 2:
        return work(std::integral_constant<int, 2>{});
      case 3:
        return work(std::integral_constant<int, 3>{});
      case 4:
        return work(std::integral_constant<int, 4>{});
      case 5:
        return work(std::integral_constant<int, 5>{});
      case 6:
        return work(std::integral_constant<int, 6>{});
      case 7:
        return work(std::integral_constant<int, 7>{});
      default:
        return work(std::integral_constant<int, SparseFactor::widest>{});
    }
  }

  [[gnu::always_inline]] static inline void eliminate_all(SparseFactor& factor) {
    auto* const all = reinterpret_cast<double*>(factor.panels_.data());
    for (const SparseFactor::Panel& node : factor.nodes_)
      for_columns(
          node.columns, [&](auto s) __attribute__((always_inline)) {
            eliminate<s()>(&factor.panels_[node.first], node.rows, &factor.inverse_[node.pivot],
                           factor.updated_.data() + node.updates, all);
          });
  }

  template <class Real>
  [[gnu::always_inline]] static inline void solve_all(const SparseFactor& factor, ComplexOf<Real>* b) {
    const auto* const all = reinterpret_cast<const double*>(factor.panels_.data());
    const std::size_t count = factor.nodes_.size();
    for (std::size_t i = 0; i < count; ++i) {
      const SparseFactor::Panel& node = factor.nodes_[i];
      for_columns(
          node.columns, [&](auto s) __attribute__((always_inline)) {
            forward<s()>(all + std::size_t{numbers} * node.first, node.rows, &factor.inverse_[node.pivot],
                         &factor.coordinates_[node.coordinate], b);
          });
    }
    for (std::size_t i = count; i-- > 0;) {
      const SparseFactor::Panel& node = factor.nodes_[i];
      for_columns(
          node.columns, [&](auto s) __attribute__((always_inline)) {
            backward<s()>(all + std::size_t{numbers} * node.first, node.rows,
                          &factor.coordinates_[node.coordinate], b);
          });
    }
  }
};

namespace {

BEAMID_WIDE_CLONE void eliminate_panels(SparseFactor& factor) {
  SparseKernels::eliminate_all(factor);
}
BEAMID_WIDE_CLONE void solve_by_panels(const SparseFactor& factor, Complex* b) {
  SparseKernels::solve_all(factor, b);
}
BEAMID_WIDE_CLONE void solve_by_panels(const SparseFactor& factor, ComplexLanes* b) {
  SparseKernels::solve_all(factor, b);
}

}  // namespace

SparseFactor::SparseFactor(const SymmetricPattern& pattern) {
  const std::vector<Supernode> found = supernodes(pattern, widest);
  const auto n = static_cast<std::size_t>(pattern.size());
  std::vector<int> owner(n), column(n), rank(n);  // of each coordinate as a column: its panel, where, when
  int next_rank = 0, next_value = 0;
  for (const Supernode& node : found) {
    const auto rows = static_cast<int>(node.rows.size());
    for (int k = 0; k < node.columns; ++k) {
      owner[node.rows[k]] = static_cast<int>(nodes_.size());
      column[node.rows[k]] = k;
      rank[node.rows[k]] = next_rank + k;
    }
    nodes_.push_back({node.columns, rows, next_value, static_cast<int>(coordinates_.size()), next_rank, 0});
    coordinates_.insert(coordinates_.end(), node.rows.begin(), node.rows.end());
    next_value += groups_of(rows) * node.columns;
    next_rank += node.columns;
  }
  panels_.resize(static_cast<std::size_t>(next_value));
  inverse_.resize(n);

  // Where a coordinate's row stands in the panel looked at last.
  std::vector<int> row(n, 0);
  int looked_at = -1;
  const auto place = [&](int of_row, int of_column) {
    const Panel& node = nodes_[owner[of_column]];
    if (owner[of_column] != looked_at) {
      looked_at = owner[of_column];
      for (int a = 0; a < node.rows; ++a) row[coordinates_[node.coordinate + a]] = a;
    }
    return numbers * node.first + place_in_panel(row[of_row], column[of_column], node.columns);
  };
  for (Panel& node : nodes_) {
    node.updates = updated_.size();
    const int* const at = &coordinates_[node.coordinate];
    for (int b = node.columns; b < node.rows; ++b)
      for (int a = b; a < node.rows; ++a) updated_.push_back(place(at[a], at[b]));
  }
  places_.resize(pattern.entries());
  for (Eigen::Index i = 0; i < pattern.size(); ++i)
    for (int k = pattern.start(i); k < pattern.start(i + 1); ++k) {
      const int one = static_cast<int>(i), other = pattern.column(k);
      places_[k] = rank[one] >= rank[other] ? place(one, other) : place(other, one);
    }
}

void SparseFactor::factor(const std::vector<Complex>& entries) {
  std::fill(panels_.begin(), panels_.end(), ComplexLanes{});
  auto* const all = reinterpret_cast<double*>(panels_.data());
  for (std::size_t k = 0; k < places_.size(); ++k) {
    all[places_[k]] = entries[k].re;
    all[places_[k] + lanes] = entries[k].im;
  }
  eliminate_panels(*this);
  double sum = 0.0;  // finite where all are
  for (const Complex& one : inverse_) sum += 0.0 * (one.re + one.im);
  if (!std::isfinite(sum))
    throw std::runtime_error("K + lambda C + lambda^2 M of the step is singular or not finite");
}

void SparseFactor::solve(Complex* b) const {
  solve_by_panels(*this, b);
}
void SparseFactor::solve(ComplexLanes* b) const {
  solve_by_panels(*this, b);
}

double SparseFactor::growth(const std::vector<Complex>& entries) const {
  double before = 0.0, met = 0.0;
  for (const Complex& one : entries) before = std::max(before, magnitude_of(one));
  const auto* const all = reinterpret_cast<const double*>(panels_.data());
  for (const Panel& node : nodes_)
    for (int k = 0; k < node.columns; ++k) {
      const Complex pivot = inverse(inverse_[node.pivot + k]);
      met = std::max(met, magnitude_of(pivot));
      for (int a = k + 1; a < node.rows; ++a)
        met = std::max(
            met, magnitude_of(pivot * entry(all + std::size_t{numbers} * node.first, a, k, node.columns)));
    }
  return met / before;
}

StepFactor::StepFactor(const SymmetricPattern& pattern) : kind_(made_for(pattern)) {}

std::variant<StepFactor::Band, SparseFactor> StepFactor::made_for(const SymmetricPattern& pattern) {
  const int width = pattern.half_width();
  if (width > narrow_band) return SparseFactor(pattern);
  Band band{BandedFactor(pattern.size(), width), {}};
  const auto stride = static_cast<std::size_t>(band.factor.width()) + 1;
  for (Eigen::Index i = 0; i < pattern.size(); ++i)
    for (int k = pattern.start(i); k < pattern.start(i + 1); ++k)
      band.places.push_back(static_cast<std::size_t>(i) * stride + (stride - 1) -
                            static_cast<std::size_t>(i - pattern.column(k)));
  return band;
}

void StepFactor::factor(const std::vector<Complex>& entries) {
  if (auto* const sparse = std::get_if<SparseFactor>(&kind_)) return sparse->factor(entries);
  auto& [factor, places] = std::get<Band>(kind_);
  factor.fill(entries, places);
  factor.factor();
}

void StepFactor::solve(Complex* b) const {
  if (const auto* const sparse = std::get_if<SparseFactor>(&kind_)) return sparse->solve(b);
  std::get<Band>(kind_).factor.solve(b);
}

void StepFactor::solve(ComplexLanes* b) const {
  if (const auto* const sparse = std::get_if<SparseFactor>(&kind_)) return sparse->solve(b);
  std::get<Band>(kind_).factor.solve(b);
}

Eigen::VectorXd StepFactor::real_part_solved(const Eigen::VectorXd& b) const {
  std::vector<Complex> x(static_cast<std::size_t>(b.size()));
  for (Eigen::Index i = 0; i < b.size(); ++i) x[i] = {b[i], 0.0};
  solve(x.data());
  Eigen::VectorXd result(b.size());
  for (Eigen::Index i = 0; i < b.size(); ++i) result[i] = x[i].re;
  return result;
}

double StepFactor::growth(const std::vector<Complex>& entries) const {
  if (const auto* const sparse = std::get_if<SparseFactor>(&kind_)) return sparse->growth(entries);
  return std::get<Band>(kind_).factor.growth(entries);
}

}  // namespace beamid::experiments::banded
