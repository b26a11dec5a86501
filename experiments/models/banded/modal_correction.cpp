#include "experiments/models/banded/modal_correction.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <complex>

#include "experiments/models/banded/banded_blocks.hpp"

namespace beamid::experiments::banded {

using Eigen::Index;

namespace {

// Sums of g_i x_i for `count` vectors g at once, in as many parts as keep additions from waiting for each
// other.
template <int count, class Real>
[[gnu::always_inline]] inline void weigh(const double* const* g, const ComplexOf<Real>* x, Index size,
                                         ComplexOf<Real>* sums) {
  constexpr int parts = count == 1 ? 4 : count == 2 ? 2 : 1;
  std::array<ComplexOf<Real>, count * parts> sum{};
  Index i = 0;
  for (; i + parts <= size; i += parts)
#pragma GCC unroll 4
    for (int part = 0; part < parts; ++part)
#pragma GCC unroll 4
      for (int k = 0; k < count; ++k) sum[k * parts + part] += g[k][i + part] * x[i + part];
  for (; i < size; ++i)
    for (int k = 0; k < count; ++k) sum[k * parts] += g[k][i] * x[i];
  for (int k = 0; k < count; ++k) {
    sums[k] = sum[k * parts];
    for (int part = 1; part < parts; ++part) sums[k] += sum[k * parts + part];
  }
}

// x -= sum of z_k factor_k
template <int count, class Real>
[[gnu::always_inline]] inline void take_off(const Complex* const* z, const ComplexOf<Real>* factors,
                                            Index size, ComplexOf<Real>* x) {
  std::array<ComplexOf<Real>, count> factor;
  for (int k = 0; k < count; ++k) factor[k] = factors[k];
  for (Index i = 0; i < size; ++i) {
    ComplexOf<Real> value = x[i];
#pragma GCC unroll 4
    for (int k = 0; k < count; ++k) value -= z[k][i] * factor[k];
    x[i] = value;
  }
}

constexpr int at_once = 4;

template <class Real>
[[gnu::always_inline]] inline void weigh_any(const double* const* g, int count, const ComplexOf<Real>* x,
                                             Index size, ComplexOf<Real>* sums) {
  if (count == 1) weigh<1>(g, x, size, sums);
  if (count == 2) weigh<2>(g, x, size, sums);
  if (count == 3) weigh<3>(g, x, size, sums);
  if (count == 4) weigh<4>(g, x, size, sums);
}
template <class Real>
[[gnu::always_inline]] inline void take_off_any(const Complex* const* z, int count,
                                                const ComplexOf<Real>* factors, Index size,
                                                ComplexOf<Real>* x) {
  if (count == 1) take_off<1>(z, factors, size, x);
  if (count == 2) take_off<2>(z, factors, size, x);
  if (count == 3) take_off<3>(z, factors, size, x);
  if (count == 4) take_off<4>(z, factors, size, x);
}
BEAMID_WIDE_CLONE void weighed(const double* const* g, int count, const Complex* x, Index size,
                               Complex* sums) {
  weigh_any(g, count, x, size, sums);
}
BEAMID_WIDE_CLONE void weighed(const double* const* g, int count, const ComplexLanes* x, Index size,
                               ComplexLanes* sums) {
  weigh_any(g, count, x, size, sums);
}
BEAMID_WIDE_CLONE void taken_off(const Complex* const* z, int count, const Complex* factors, Index size,
                                 Complex* x) {
  take_off_any(z, count, factors, size, x);
}
BEAMID_WIDE_CLONE void taken_off(const Complex* const* z, int count, const ComplexLanes* factors, Index size,
                                 ComplexLanes* x) {
  take_off_any(z, count, factors, size, x);
}

}  // namespace

Complex inner(const double* g, const Complex* x, Index size) {
  Complex sum;
  weighed(&g, 1, x, size, &sum);
  return sum;
}

void ModalCorrection::factor(const StepFactor& factored, const std::vector<ModeDamping>& modes,
                             const Complex& lambda, Complex* b) {
  const auto count = static_cast<Index>(modes.size());
  Eigen::MatrixXcd overlaps(count, count + 1);
  responses_.resize(count);
  for (Index first = 0; first <= count; first += Lanes::count) {
    const Index columns = std::min<Index>(count + 1 - first, Lanes::count);
    const double* from[Lanes::count];
    for (Index k = 0; k < Lanes::count; ++k)
      from[k] = first + k < count ? modes[first + k].momentum.data() : zeros_.data();
    gather(from, size_, lanes_.data());
    for (Index i = 0; i < size_; ++i) block_[i] = {lanes_[i], {}};
    if (const Index own = count - first; own < Lanes::count)
      for (Index i = 0; i < size_; ++i) {
        block_[i].re.values[own] = b[i].re;
        block_[i].im.values[own] = b[i].im;
      }
    factored.solve(block_.data());
    const std::vector<ComplexLanes> seen = overlaps_of(modes, block_.data());
    for (Index mode = 0; mode < count; ++mode)
      for (Index k = 0; k < columns; ++k)
        overlaps(mode, first + k) = {seen[mode].re.values[k], seen[mode].im.values[k]};
    for (Index k = 0; k < columns; ++k) {
      Complex* to = b;
      if (first + k < count) {
        responses_[first + k].resize(size_);
        to = responses_[first + k].data();
      }
      for (Index i = 0; i < size_; ++i) to[i] = {block_[i].re.values[k], block_[i].im.values[k]};
    }
  }
  Eigen::MatrixXcd system = Eigen::MatrixXcd::Identity(count, count), weights = system;
  for (Index i = 0; i < count; ++i) {
    weights(i, i) = std::complex<double>(lambda.re, lambda.im) * modes[i].factor;
    system.row(i) += weights(i, i) * overlaps.row(i).head(count);
  }
  weights = system.partialPivLu().solve(weights).eval();
  coupling_.resize(count * count);
  for (Index i = 0; i < count; ++i)
    for (Index k = 0; k < count; ++k) coupling_[i * count + k] = {weights(i, k).real(), weights(i, k).imag()};
  std::vector<Complex> seen(count);
  for (Index i = 0; i < count; ++i) seen[i] = {overlaps(i, count).real(), overlaps(i, count).imag()};
  take_response_off(seen.data(), b);
}

template <class Real>
void ModalCorrection::take_response_off(const ComplexOf<Real>* seen, ComplexOf<Real>* b) const {
  const std::size_t count = responses_.size();
  for (std::size_t first = 0; first < count; first += at_once) {
    const auto now = static_cast<int>(std::min<std::size_t>(at_once, count - first));
    const Complex* z[at_once];
    ComplexOf<Real> factors[at_once];
    for (int i = 0; i < now; ++i) {
      z[i] = responses_[first + i].data();
      for (std::size_t k = 0; k < count; ++k) factors[i] += coupling_[(first + i) * count + k] * seen[k];
    }
    taken_off(z, now, factors, size_, b);
  }
}

template <class Real>
std::vector<ComplexOf<Real>> ModalCorrection::overlaps_of(const std::vector<ModeDamping>& modes,
                                                          const ComplexOf<Real>* b) const {
  const std::size_t count = modes.size();
  std::vector<ComplexOf<Real>> seen(count);
  for (std::size_t first = 0; first < count; first += at_once) {
    const auto now = static_cast<int>(std::min<std::size_t>(at_once, count - first));
    const double* g[at_once];
    for (int k = 0; k < now; ++k) g[k] = modes[first + k].momentum.data();
    weighed(g, now, b, size_, &seen[first]);
  }
  return seen;
}

template <class Real>
void ModalCorrection::correct(const std::vector<ModeDamping>& modes, ComplexOf<Real>* b) const {
  if (!modes.empty()) take_response_off(overlaps_of(modes, b).data(), b);
}

void ModalCorrection::operator()(const std::vector<ModeDamping>& modes, Complex* b) const {
  correct(modes, b);
}
void ModalCorrection::operator()(const std::vector<ModeDamping>& modes, ComplexLanes* b) const {
  correct(modes, b);
}

}  // namespace beamid::experiments::banded
