#include "experiments/models/banded/banded_factor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace beamid::experiments::banded {
namespace {

using Eigen::Index;

// Widths that loops are unrolled for. Zeros fill up what a band has less.
int stored_width(int width) {
  for (const int stored : {3, 5, 8, 16, BandedFactor::widest})
    if (width <= stored) return stored;
  throw std::invalid_argument("equations of motion couple coordinates " + std::to_string(width) +
                              " places apart; expected at most " + std::to_string(BandedFactor::widest) +
                              " (few absorbers at one place)");
}

// u = row i of L D, then L and 1/D in its place. The last `width` rows of L and of 1/D are before it.
template <int width>
[[gnu::always_inline]] inline void factor_rows(Complex* rows, Index size) {
  constexpr Index stride = width + 1;
  for (Index i = 0; i < size; ++i) {
    Complex* const row = rows + i * stride;
    const int start = i < width ? width - static_cast<int>(i) : 0;
    std::array<Complex, width> u;
    Complex pivot = row[width];
#pragma GCC unroll 8
    for (int j = start; j < width; ++j) {
      const Complex* const other = row - (width - j) * stride;  // the row of column j
      Complex value = row[j];
#pragma GCC unroll 8
      for (int k = start; k < j; ++k) value -= u[k] * other[k + width - j];
      u[j] = value;
      row[j] = other[width] * value;
      pivot -= value * row[j];
    }
    row[width] = inverse(pivot);
  }
}

// Forward with the newest `width` unknowns at hand; backward each unknown is taken off the `width` before it
// as soon as it is known, so that rows of L serve both ways.
template <int width, class Real>
[[gnu::always_inline]] inline void solve_rows(const Complex* rows, Index size, ComplexOf<Real>* b) {
  constexpr Index stride = width + 1;
  std::array<ComplexOf<Real>, width> recent{};
  for (Index i = 0; i < size; ++i) {
    const Complex* const row = rows + i * stride;
    ComplexOf<Real> value = b[i];
#pragma GCC unroll 8
    for (int k = 0; k < width; ++k) value -= row[k] * recent[k];
#pragma GCC unroll 8
    for (int k = 0; k + 1 < width; ++k) recent[k] = recent[k + 1];
    recent[width - 1] = value;
    b[i] = row[width] * value;
  }
  const auto scaled = [&](Index i) { return i < 0 ? ComplexOf<Real>{} : b[i]; };
#pragma GCC unroll 8
  for (int k = 0; k < width; ++k) recent[k] = scaled(size - width + k);
  for (Index i = size - 1; i >= 0; --i) {
    const Complex* const row = rows + i * stride;
    const ComplexOf<Real> value = recent[width - 1];
    b[i] = value;
#pragma GCC unroll 8
    for (int k = width - 1; k > 0; --k) {
      recent[k] = recent[k - 1];
      recent[k] -= row[k] * value;
    }
    recent[0] = scaled(i - width);
    recent[0] -= row[0] * value;
  }
}

#define BEAMID_FOR_WIDTH(width)                                                            \
  BEAMID_WIDE_CLONE void factor_##width(Complex* rows, Index size) {                       \
    factor_rows<width>(rows, size);                                                        \
  }                                                                                        \
  BEAMID_WIDE_CLONE void solve_##width(const Complex* rows, Index size, Complex* b) {      \
    solve_rows<width>(rows, size, b);                                                      \
  }                                                                                        \
  BEAMID_WIDE_CLONE void solve_##width(const Complex* rows, Index size, ComplexLanes* b) { \
    solve_rows<width>(rows, size, b);                                                      \
  }
BEAMID_FOR_WIDTH(3)
BEAMID_FOR_WIDTH(5)
BEAMID_FOR_WIDTH(8)
BEAMID_FOR_WIDTH(16)
BEAMID_FOR_WIDTH(32)

double magnitude(const Complex& z) {
  return std::hypot(z.re, z.im);
}

}  // namespace

BandedFactor::BandedFactor(Index size, int width)
    : size_(size), width_(stored_width(width)), rows_(static_cast<std::size_t>(size) * (width_ + 1)) {}

void BandedFactor::fill(const std::vector<Complex>& entries, const std::vector<std::size_t>& places) {
  std::fill(rows_.begin(), rows_.end(), Complex{});
  for (std::size_t k = 0; k < places.size(); ++k) rows_[places[k]] = entries[k];
}

void BandedFactor::factor() {
  Complex* const rows = rows_.data();
  if (width_ == 3) factor_3(rows, size_);
  if (width_ == 5) factor_5(rows, size_);
  if (width_ == 8) factor_8(rows, size_);
  if (width_ == 16) factor_16(rows, size_);
  if (width_ == 32) factor_32(rows, size_);
  // What is not a number spreads along the band to its last row.
  if (size_ > 0 && !std::isfinite(magnitude(row(size_ - 1)[width_])))
    throw std::runtime_error("K + lambda C + lambda^2 M of the step is singular or not finite");
}

void BandedFactor::solve(Complex* b) const {
  solve_any(rows_.data(), b);
}
void BandedFactor::solve(ComplexLanes* b) const {
  solve_any(rows_.data(), b);
}

template <class Entry>
void BandedFactor::solve_any(const Complex* rows, Entry* b) const {
  if (width_ == 3) solve_3(rows, size_, b);
  if (width_ == 5) solve_5(rows, size_, b);
  if (width_ == 8) solve_8(rows, size_, b);
  if (width_ == 16) solve_16(rows, size_, b);
  if (width_ == 32) solve_32(rows, size_, b);
}

double BandedFactor::growth(const std::vector<Complex>& unfactored) const {
  double before = 0.0, met = 0.0;
  for (const Complex& entry : unfactored) before = std::max(before, magnitude(entry));
  for (Index i = 0; i < size_; ++i) {
    const Complex* const row = &rows_[static_cast<std::size_t>(i) * (width_ + 1)];
    met = std::max(met, magnitude(inverse(row[width_])));
    for (int k = 0; k < width_ && i - width_ + k >= 0; ++k) {
      const Complex* const other = row - (width_ - k) * (width_ + 1);
      met = std::max(met, magnitude(inverse(other[width_]) * row[k]));
    }
  }
  return met / before;
}

}  // namespace beamid::experiments::banded
