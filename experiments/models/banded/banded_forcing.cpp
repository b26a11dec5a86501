// What the unknowns do to a step: dF/du - dS/du d of BandedStep.
#include <algorithm>
#include <tuple>

#include "experiments/models/banded/banded_step.hpp"

namespace beamid::experiments::banded {

using Eigen::Index;

// K_j (q - (1 + lambda beta) d) - lambda M_j (q' + (lambda + alpha) d) - E_j f - lambda C_j d
void BandedStep::by_property(const BandedEquations& equations, Index j, const double* q, const double* rate,
                             const StepForce& force_slope, Forcing& forcing) const {
  forcing.rows.assign(size_, {});
  std::tie(forcing.first, forcing.last) = equations.stiffness().reach(j);
  const auto include = [&](Index i) {
    if (forcing.first == forcing.last) forcing.first = i, forcing.last = i + 1;
    forcing.first = std::min(forcing.first, i);
    forcing.last = std::max(forcing.last, i + 1);
  };
  if (forcing.first != forcing.last) {
    const Complex shrink{1.0 + lambda_.re * equations.stiffness_damping(),
                         lambda_.im * equations.stiffness_damping()};
    for (Index i = forcing.first; i < forcing.last; ++i)
      point_[i] = Complex{q[i], 0.0} - shrink * solution_[i];
    equations.stiffness().add_slope_product(j, point_.data(), forcing.rows.data());
  }
  const auto [dashpots_from, dashpots_to] = equations.dashpots().reach(j);
  if (dashpots_from != dashpots_to) {
    include(dashpots_from);
    include(dashpots_to - 1);
    for (Index i = dashpots_from; i < dashpots_to; ++i) point_[i] = -1.0 * (lambda_ * solution_[i]);
    equations.dashpots().slope(j).add_product(point_.data(), forcing.rows.data());
  }
  const Complex shifted = lambda_ + Complex{equations.mass_damping(), 0.0};
  for (const BandedMass::Entry& entry : equations.mass().slope(j)) {
    const Complex moving = lambda_ * (Complex{rate[entry.column], 0.0} + shifted * solution_[entry.column]);
    forcing.rows[entry.row] -= entry.value * moving;
    include(entry.row);
  }
  if (equations.force_depends_on(j))
    for (Index i = 0; i < size_; ++i)
      if (force_slope.re[i] != 0.0 || force_slope.im[i] != 0.0)
        forcing.rows[i] -= Complex{force_slope.re[i], force_slope.im[i]}, include(i);
  forcing.along.resize(equations.mode_dampings().size());
  for (std::size_t k = 0; k < equations.mode_dampings().size(); ++k) {
    const ModeDamping& mode = equations.mode_dampings()[k];
    forcing.along[k] = lambda_ * (mode.by_property[j] * modes_seen_[k]);
    if (equations.mass().slope(j).empty()) continue;  // nor does the momentum change then
    const double* const slope = equations.damped_modes()[k].momentum_slopes.col(j).data();
    forcing.along[k] += lambda_ * (mode.factor * inner(slope, solution_.data(), size_));
    const Complex along_slope = lambda_ * (mode.factor * modes_seen_[k]);
    for (Index i = 0; i < size_; ++i) forcing.rows[i] -= slope[i] * along_slope;
    forcing.first = 0;
    forcing.last = size_;
  }
}

void BandedStep::by_mass_damping(const BandedEquations& equations, Forcing& forcing) const {
  forcing = {std::vector<Complex>(size_), 0, size_, {}};
  std::vector<double> part(size_), product(size_);
  for (const bool imaginary : {false, true}) {
    for (Index i = 0; i < size_; ++i) {
      const Complex moving = lambda_ * solution_[i];
      part[i] = imaginary ? moving.im : moving.re;
    }
    equations.mass().multiply(part.data(), product.data());
    for (Index i = 0; i < size_; ++i) (imaginary ? forcing.rows[i].im : forcing.rows[i].re) = -product[i];
  }
}

void BandedStep::by_stiffness_damping(const BandedEquations& equations, Forcing& forcing) const {
  forcing = {std::vector<Complex>(size_), 0, size_, {}};
  for (Index i = 0; i < size_; ++i) point_[i] = -1.0 * (lambda_ * solution_[i]);
  equations.stiffness().add_product(point_.data(), forcing.rows.data());
}

void BandedStep::by_ratio(const BandedEquations& equations, const std::vector<Index>& modes,
                          Forcing& forcing) const {
  forcing = {{}, 0, 0, std::vector<Complex>(equations.mode_dampings().size())};
  for (const Index k : modes)
    forcing.along[k] = equations.mode_dampings()[k].by_ratio * (lambda_ * modes_seen_[k]);
}

}  // namespace beamid::experiments::banded
