#include "experiments/models/banded/banded_step.hpp"

#include <algorithm>
#include <array>
#include <complex>
#include <limits>
#include <numbers>

#include <Eigen/LU>

#include "experiments/models/banded/banded_blocks.hpp"

namespace beamid::experiments::banded {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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

using std::numbers::sqrt3;

namespace {

// Whether rounding of the assembled S, beside lambda^2 M, is more than a residual is worth. At this size the
// frequency that the steps show is 1e-13 off (docs/theory/continuum_filter.md, Digits).
bool rounding_counts(const BandedEquations& equations, double interval) {
  constexpr double least = 1e-10;
  const double rounding = std::numeric_limits<double>::epsilon();
  return !(equations.highest_squared_frequency() * interval * interval / 12.0 * rounding < least);
}

}  // namespace

BandedStep::BandedStep(const BandedEquations& equations, double interval)
    : size_(equations.size()),
      interval_(interval),
      refines_(rounding_counts(equations, interval)),
      lambda_{3.0 / interval, sqrt3 / interval},
      factor_(equations.pattern()),
      correction_(size_),
      solution_(size_),
      right_(size_),
      work_(size_),
      work_rate_(size_),
      zeros_(size_),
      nowhere_(size_),
      point_(size_),
      lanes_(size_),
      lanes_rate_(size_),
      lanes_work_(size_),
      block_(size_) {}

void BandedStep::factor(const BandedEquations& equations) {
  equations.assemble(lambda_, entries_);
  factor_.factor(entries_);
  if (watches_growth_) growth_ = factor_.growth(entries_);
  is_new_ = true;
}

template <class Real>
void BandedStep::solve(const BandedEquations& equations, ComplexOf<Real>* b) const {
  factor_.solve(b);
  if (!equations.mode_dampings().empty()) correction_(equations.mode_dampings(), b);
}

void BandedStep::advance(const BandedEquations& equations, const double* q, const double* rate,
                         const StepForce& force, double* next, double* next_rate) {
  for (Index i = 0; i < size_; ++i) work_[i] = -force.re[i];
  equations.stiffness().add_product(q, work_.data());
  equations.mass().multiply(rate, work_rate_.data());
  for (Index i = 0; i < size_; ++i)
    solution_[i] = {work_[i] - lambda_.re * work_rate_[i], -force.im[i] - lambda_.im * work_rate_[i]};
  if (refines_) std::copy(solution_.begin(), solution_.end(), right_.begin());
  if (is_new_ && !equations.mode_dampings().empty())
    correction_.factor(factor_, equations.mode_dampings(), lambda_, solution_.data());
  else
    solve(equations, solution_.data());
  is_new_ = false;
  if (refines_) refine(equations);
  modes_seen_.clear();
  for (const ModeDamping& mode : equations.mode_dampings())
    modes_seen_.push_back(inner(mode.momentum.data(), solution_.data(), size_));
  const double step = 4.0 * sqrt3, pace = 12.0 / interval_;
  for (Index i = 0; i < size_; ++i) {
    next[i] = q[i] + step * solution_[i].im;
    next_rate[i] = rate[i] + pace * (solution_[i].re + sqrt3 * solution_[i].im);
  }
}

// The residual of S d through the strain factors, of which the factored S has lost digits, and what it takes
// off d.
void BandedStep::refine(const BandedEquations& equations) {
  const double beta = equations.stiffness_damping();
  const Complex by_mass = lambda_ * (lambda_ + Complex{equations.mass_damping(), 0.0});
  for (Index i = 0; i < size_; ++i)
    point_[i] = Complex{-1.0 - lambda_.re * beta, -lambda_.im * beta} * solution_[i];
  equations.stiffness().add_product(point_.data(), right_.data());
  for (Index i = 0; i < size_; ++i) point_[i] = by_mass * solution_[i];
  equations.mass().take_off(point_.data(), right_.data());
  for (Index i = 0; i < size_; ++i) point_[i] = -1.0 * (lambda_ * solution_[i]);
  equations.dashpots().now().add_product(point_.data(), right_.data());
  for (const ModeDamping& mode : equations.mode_dampings()) {
    const Complex seen = mode.factor * inner(mode.momentum.data(), point_.data(), size_);
    for (Index i = 0; i < size_; ++i) right_[i] += mode.momentum[i] * seen;
  }
  solve(equations, right_.data());
  for (Index i = 0; i < size_; ++i) solution_[i] += right_[i];
}

void BandedStep::move(const BandedEquations& equations, const std::vector<Forcing>& forcings,
                      const MatrixXd& parts, MatrixXd& directions) {
  for (Index first = 0; first < directions.cols(); first += Lanes::count) {
    const int count = static_cast<int>(std::min<Index>(Lanes::count, directions.cols() - first));
    const double *from[Lanes::count], *from_rates[Lanes::count];
    double *to[Lanes::count], *to_rates[Lanes::count];
    for (int k = 0; k < Lanes::count; ++k) {  // those beyond the last column come from nothing and go nowhere
      to[k] = k < count ? directions.col(first + k).data() : nowhere_.data();
      to_rates[k] = k < count ? to[k] + size_ : nowhere_.data();
      from[k] = k < count ? to[k] : zeros_.data();
      from_rates[k] = k < count ? to_rates[k] : zeros_.data();
    }
    gather(from, size_, lanes_.data());
    gather(from_rates, size_, lanes_rate_.data());
    std::fill(lanes_work_.begin(), lanes_work_.end(), Lanes{});
    equations.stiffness().add_product(lanes_.data(), lanes_work_.data());
    equations.mass().multiply(lanes_rate_.data(), lanes_.data());
    right_side(lanes_work_.data(), lanes_.data(), interval_, size_, block_.data());
    add_forcings(equations, forcings, parts, first, count);
    solve(equations, block_.data());
    scatter(block_.data(), interval_, size_, to, to_rates);
  }
}

// On the block of directions first, first + 1, ...
void BandedStep::add_forcings(const BandedEquations& equations, const std::vector<Forcing>& forcings,
                              const MatrixXd& parts, Index first, int count) {
  const std::vector<ModeDamping>& modes = equations.mode_dampings();
  std::vector<ComplexLanes> along(modes.size());
  bool any_along = false;
  for (std::size_t u = 0; u < forcings.size(); ++u) {
    Lanes part;
    bool any = false;
    for (int k = 0; k < count; ++k) {
      part.values[k] = parts(static_cast<Index>(u), first + k);
      any = any || part.values[k] != 0.0;
    }
    if (!any) continue;
    const Forcing& forcing = forcings[u];
    add_forcing(forcing.rows.data(), part, forcing.first, forcing.last, block_.data());
    for (std::size_t i = 0; i < forcing.along.size(); ++i) {
      along[i] -= {forcing.along[i].re * part, forcing.along[i].im * part};
      any_along = true;
    }
  }
  if (!any_along) return;
  std::vector<const double*> momenta;
  for (const ModeDamping& mode : modes) momenta.push_back(mode.momentum.data());
  add_multiples(momenta.data(), along.data(), static_cast<int>(modes.size()), size_, block_.data());
}

}  // namespace beamid::experiments::banded
