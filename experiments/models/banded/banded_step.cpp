#include "experiments/models/banded/banded_step.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "experiments/models/banded/banded_blocks.hpp"

namespace beamid::experiments::banded {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
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
