#include "experiments/models/banded/banded_mass.hpp"

#include <algorithm>
#include <cstdlib>
#include <set>

namespace beamid::experiments::banded {

using Eigen::Index;

namespace {

constexpr int plain_width = 3;  // of an Euler-Bernoulli beam

// use(i, (M x)_i) of every row.
template <class Entry, class Use>
[[gnu::always_inline]] inline void multiply_band(const double* band, Index size, int width, const Entry* x,
                                                 const Use& use) {
  const auto row_product = [&](Index i, Index from, Index to) {
    const double* const row = band + i * (2 * width + 1) + width - i;
    Entry sum{};
    for (Index j = from; j < to; ++j) sum += row[j] * x[j];
    use(i, sum);
  };
  const Index edge = std::min<Index>(width, size);
  for (Index i = 0; i < edge; ++i) row_product(i, 0, std::min<Index>(size, i + width + 1));
  for (Index i = edge; i < size - width; ++i) {
    const double* const row = band + i * (2 * width + 1);
    const Entry* const start = x + (i - width);
    Entry sum = row[0] * start[0];
#pragma GCC unroll 8
    for (int k = 1; k <= 2 * width; ++k) sum += row[k] * start[k];
    use(i, sum);
  }
  for (Index i = std::max(edge, size - width); i < size; ++i) row_product(i, i - width, size);
}

BEAMID_WIDE_CLONE void multiply_lanes(const double* band, Index size, int width, const Lanes* x, Lanes* y) {
  const auto set = [y](Index i, const Lanes& sum) { y[i] = sum; };
  if (width == plain_width)
    multiply_band(band, size, plain_width, x, set);
  else
    multiply_band(band, size, width, x, set);
}

}  // namespace

BandedMass::BandedMass(const fem::ParametricSystem& equations) : size_(equations.system.size()) {
  std::set<Index> touched;
  const auto visit = [](const fem::SparseMatrix& matrix, const auto& use) {
    for (int j = 0; j < matrix.outerSize(); ++j)
      for (fem::SparseMatrix::InnerIterator it(matrix, j); it; ++it)
        if (it.value() != 0.0) use(Index{it.row()}, Index{j}, it.value());
  };
  const auto widen = [&](Index i, Index j, double) {
    width_ = std::max(width_, static_cast<int>(std::abs(i - j)));
  };
  visit(equations.system.mass, widen);
  for (const auto& derivative : equations.derivatives) {
    visit(derivative.mass, widen);
    slopes_.emplace_back();
    visit(derivative.mass, [&](Index i, Index j, double value) {
      slopes_.back().push_back({i, j, value});
      touched.insert(i);
    });
  }
  support_.assign(touched.begin(), touched.end());
  if (!is_band()) {
    std::vector<const fem::SparseMatrix*> slopes;
    for (const auto& derivative : equations.derivatives) slopes.push_back(&derivative.mass);
    rows_ = ParametricRows(equations.system.mass, slopes);
    return;
  }
  reference_.assign(static_cast<std::size_t>(size_) * (2 * width_ + 1), 0.0);
  visit(equations.system.mass, [&](Index i, Index j, double value) { reference_[place(i, j)] = value; });
  band_ = reference_;
}

void BandedMass::set(const Eigen::VectorXd& change) {
  if (is_constant()) return;
  if (!is_band()) return rows_.set(change);
  for (const auto& slope : slopes_)
    for (const Entry& entry : slope)
      band_[place(entry.row, entry.column)] = reference_[place(entry.row, entry.column)];
  for (std::size_t j = 0; j < slopes_.size(); ++j)
    for (const Entry& entry : slopes_[j])
      band_[place(entry.row, entry.column)] += change[static_cast<Index>(j)] * entry.value;
}

void BandedMass::multiply(const double* x, double* y) const {
  if (!is_band()) return rows_.now().multiply(x, y);
  const auto set = [y](Index i, double sum) { y[i] = sum; };
  if (width_ == plain_width)
    multiply_band(band_.data(), size_, plain_width, x, set);
  else
    multiply_band(band_.data(), size_, width_, x, set);
}

void BandedMass::take_off(const Complex* x, Complex* y) const {
  if (!is_band()) return rows_.now().add_product(x, y, -1.0);
  const auto subtract = [y](Index i, const Complex& sum) { y[i] -= sum; };
  if (width_ == plain_width)
    multiply_band(band_.data(), size_, plain_width, x, subtract);
  else
    multiply_band(band_.data(), size_, width_, x, subtract);
}

void BandedMass::multiply(const Lanes* x, Lanes* y) const {
  if (is_band())
    multiply_lanes(band_.data(), size_, width_, x, y);
  else
    rows_.now().multiply(x, y);
}

}  // namespace beamid::experiments::banded
