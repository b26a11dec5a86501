#include "experiments/models/banded/strain_product.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace beamid::experiments::banded {
namespace {

// use(i, (A x)_i) of every row.
template <class Entry, class Use>
[[gnu::always_inline]] inline void multiply_rows(const std::vector<int>& start, const int* column,
                                                 const double* value, const Entry* x, const Use& use) {
  for (std::size_t i = 0; i + 1 < start.size(); ++i) {
    Entry sum{};
    for (int k = start[i]; k < start[i + 1]; ++k) sum += value[k] * x[column[k]];
    use(i, sum);
  }
}

BEAMID_WIDE_CLONE void set_rows(const std::vector<int>& start, const int* column, const double* value,
                                const Lanes* x, Lanes* y) {
  multiply_rows(start, column, value, x, [y](std::size_t i, const Lanes& sum) { y[i] = sum; });
}
template <class Entry>
void set_rows(const std::vector<int>& start, const int* column, const double* value, const Entry* x,
              Entry* y) {
  multiply_rows(start, column, value, x, [y](std::size_t i, const Entry& sum) { y[i] = sum; });
}

BEAMID_WIDE_CLONE void add_rows(const std::vector<int>& start, const int* column, const double* value,
                                const Lanes* x, Lanes* y, double factor) {
  multiply_rows(start, column, value, x,
                [y, factor](std::size_t i, const Lanes& sum) { y[i] += factor * sum; });
}
template <class Entry>
void add_rows(const std::vector<int>& start, const int* column, const double* value, const Entry* x, Entry* y,
              double factor) {
  multiply_rows(start, column, value, x,
                [y, factor](std::size_t i, const Entry& sum) { y[i] += factor * sum; });
}

}  // namespace

SparseRows::SparseRows(const fem::SparseMatrix& matrix) {
  const Eigen::SparseMatrix<double, Eigen::RowMajor> rows = matrix;
  start_.assign(rows.outerIndexPtr(), rows.outerIndexPtr() + rows.rows() + 1);
  column_.assign(rows.innerIndexPtr(), rows.innerIndexPtr() + rows.nonZeros());
  value_.assign(rows.valuePtr(), rows.valuePtr() + rows.nonZeros());
}

template <class Entry>
void SparseRows::multiply(const Entry* x, Entry* y) const {
  set_rows(start_, column_.data(), value_.data(), x, y);
}
template <class Entry>
void SparseRows::add_product(const Entry* x, Entry* y, double factor) const {
  if (is_empty()) return;
  add_rows(start_, column_.data(), value_.data(), x, y, factor);
}
template void SparseRows::multiply(const double* x, double* y) const;
template void SparseRows::multiply(const Complex* x, Complex* y) const;
template void SparseRows::multiply(const Lanes* x, Lanes* y) const;
template void SparseRows::add_product(const double* x, double* y, double factor) const;
template void SparseRows::add_product(const Complex* x, Complex* y, double factor) const;
template void SparseRows::add_product(const Lanes* x, Lanes* y, double factor) const;

void SparseRows::add_form(const Lanes* x, const double* y, Lanes& total) const {
  if (is_empty()) return;
  multiply_rows(start_, column_.data(), value_.data(), y,
                [x, &total](std::size_t i, double sum) { total += sum * x[i]; });
}

EntryList SparseRows::entries_of(const fem::SparseMatrix& matrix) const {
  EntryList entries;
  for (int j = 0; j < matrix.outerSize(); ++j)
    for (fem::SparseMatrix::InnerIterator it(matrix, j); it; ++it) {
      const auto first = column_.begin() + start_[it.row()], last = column_.begin() + start_[it.row() + 1];
      entries.place.push_back(static_cast<int>(std::lower_bound(first, last, j) - column_.begin()));
      entries.value.push_back(it.value());
    }
  return entries;
}

using Eigen::Index;

StrainProduct::StrainProduct(const fem::SparseMatrix& strain, const fem::SparseMatrix& rigidity,
                             const std::vector<int>& starts) {
  const Eigen::SparseMatrix<double, Eigen::RowMajor> rows = strain, entries = rigidity;
  row_start_.assign(rows.outerIndexPtr(), rows.outerIndexPtr() + rows.rows() + 1);
  column_.assign(rows.innerIndexPtr(), rows.innerIndexPtr() + rows.nonZeros());
  value_.assign(rows.valuePtr(), rows.valuePtr() + rows.nonZeros());
  Index first = strain.cols(), last = 0;
  for (std::size_t b = 0; b + 1 < starts.size(); ++b) {
    const Block block{starts[b], starts[b + 1] - starts[b], static_cast<int>(rigidity_.size())};
    if (block.size > largest_block)
      throw std::invalid_argument("rigidity couples " + std::to_string(block.size) +
                                  " strains; expected at most " + std::to_string(largest_block) +
                                  ", those of one element");
    std::array<double, largest_block * largest_block> own{};
    bool any = false;
    for (int r = 0; r < block.size; ++r)
      for (decltype(entries)::InnerIterator it(entries, block.strain + r); it; ++it) {
        own[r * block.size + it.col() - block.strain] = it.value();
        any = true;  // a zero may be there to be added to
      }
    if (!any) continue;
    for (int k = row_start_[block.strain]; k < row_start_[block.strain + block.size]; ++k) {
      first = std::min<Index>(first, column_[k]);
      last = std::max<Index>(last, column_[k] + 1);
    }
    if (add_element(block, own.data())) continue;
    blocks_.push_back(block);
    rigidity_.insert(rigidity_.end(), own.begin(), own.begin() + block.size * block.size);
  }
  reach_ = {std::min(first, last), last};
}

bool StrainProduct::add_element(const Block& block, const double* rigidity) {
  if (block.size != 2) return false;
  const int row = row_start_[block.strain];
  const int* const column = &column_[row];
  const double* const value = &value_[row];
  if (row_start_[block.strain + 1] != row + 3 || row_start_[block.strain + 2] != row + 5) return false;
  const int w = column[0];
  if (column[1] != w + 1 || column[2] != w + 2 || column[3] != w + 1 || column[4] != w + 3) return false;
  if (value[0] != 1.0 || value[2] != -1.0) return false;
  const auto place = static_cast<int>(elements_.size());
  const bool follows = !runs_.empty() && runs_.back().coordinate + 2 * (place - runs_.back().first) == w;
  if (!follows) runs_.push_back({w, place, place});
  runs_.back().last = place + 1;
  const double coupling = 0.5 * (rigidity[1] + rigidity[2]);
  elements_.push_back({value[1], value[3], value[4], rigidity[0], coupling, rigidity[3], block.strain});
  return true;
}

void StrainProduct::take_rigidity(const StrainProduct& other) {
  elements_ = other.elements_;
  rigidity_ = other.rigidity_;
}

void StrainProduct::add(double factor, const StrainProduct& part) {
  auto own = elements_.begin();
  for (const Element& other : part.elements_) {
    while (own->strain != other.strain) ++own;
    own->d11 += factor * other.d11;
    own->d12 += factor * other.d12;
    own->d22 += factor * other.d22;
  }
  auto block = blocks_.begin();
  for (const Block& other : part.blocks_) {
    while (block->strain != other.strain) ++block;
    for (int k = 0; k < other.size * other.size; ++k)
      rigidity_[block->rigidity + k] += factor * part.rigidity_[other.rigidity + k];
  }
}

template <class Entry>
[[gnu::always_inline]] inline void StrainProduct::strains(const Block& block, const Entry* x,
                                                          Entry* e) const {
  for (int r = 0; r < block.size; ++r) {
    const int begin = row_start_[block.strain + r], end = row_start_[block.strain + r + 1];
    Entry sum{};
    for (int k = begin; k < end; ++k) sum += value_[k] * x[column_[k]];
    e[r] = sum;
  }
}

template <class Entry>
[[gnu::always_inline]] inline void StrainProduct::multiply(const Entry* x, Entry* y) const {
  for (const Run& run : runs_) {
    const Entry* here = x + run.coordinate;
    Entry* out = y + run.coordinate;
    Entry w = here[0], t = here[1], force = out[0], moment = out[1];
    for (const Element *e = &elements_[run.first], *end = e + (run.last - run.first); e != end; ++e) {
      const Entry next_w = here[2], next_t = here[3];
      const Entry drift = w - next_w + e->a * t, bend = e->b * t + e->c * next_t;
      const Entry n = e->d11 * drift + e->d12 * bend, m = e->d12 * drift + e->d22 * bend;
      out[0] = force + n;
      out[1] = moment + (e->a * n + e->b * m);
      force = out[2] - n;
      moment = out[3] + e->c * m;
      w = next_w;
      t = next_t;
      here += 2;
      out += 2;
    }
    out[0] = force;
    out[1] = moment;
  }
  std::array<Entry, largest_block> e;
  for (const Block& block : blocks_) {
    strains(block, x, e.data());
    const double* const rigidity = &rigidity_[block.rigidity];
    for (int r = 0; r < block.size; ++r) {
      Entry force{};
      for (int c = 0; c < block.size; ++c) force += rigidity[r * block.size + c] * e[c];
      for (int k = row_start_[block.strain + r]; k < row_start_[block.strain + r + 1]; ++k)
        y[column_[k]] += value_[k] * force;
    }
  }
}

template <>
void StrainProduct::operator()(const double* x, double* y) const {
  multiply(x, y);
}
template <>
void StrainProduct::operator()(const Complex* x, Complex* y) const {
  multiply(x, y);
}
template <>
BEAMID_WIDE_CLONE void StrainProduct::operator()(const Lanes* x, Lanes* y) const {
  multiply(x, y);
}

BEAMID_WIDE_CLONE void StrainProduct::add_form(const Lanes* x, const double* y, Lanes& total) const {
  Lanes sum{};
  for (const Run& run : runs_) {
    const Lanes* left = x + run.coordinate;
    const double* right = y + run.coordinate;
    for (const Element *e = &elements_[run.first], *end = e + (run.last - run.first); e != end; ++e) {
      const double drift = right[0] - right[2] + e->a * right[1], bend = e->b * right[1] + e->c * right[3];
      const Lanes other_drift = left[0] - left[2] + e->a * left[1];
      const Lanes other_bend = e->b * left[1] + e->c * left[3];
      sum += (e->d11 * drift + e->d12 * bend) * other_drift + (e->d12 * drift + e->d22 * bend) * other_bend;
      left += 2;
      right += 2;
    }
  }
  std::array<Lanes, largest_block> one;
  std::array<double, largest_block> other;
  for (const Block& block : blocks_) {
    strains(block, x, one.data());
    strains(block, y, other.data());
    for (int r = 0; r < block.size; ++r) {
      double force = 0.0;
      for (int c = 0; c < block.size; ++c) force += rigidity_[block.rigidity + r * block.size + c] * other[c];
      sum += force * one[r];
    }
  }
  total += sum;
}

}  // namespace beamid::experiments::banded
