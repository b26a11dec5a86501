// Derivatives of what sensors read, by the state and by the unknowns.
#include "experiments/models/banded/continuum_sensors.hpp"

namespace beamid::experiments::banded {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

struct ContinuumSensors::Motion {
  const double *q, *rate;
  const VectorXd& input;
  VectorXd accelerations = {};
};

// Of -g^T (C q' + K q) + g^T E f along one unknown, M g = h held: - g^T M_j a comes with g.
double ContinuumSensors::by_drive(const BandedEquations& equations, Index unknown, Index sensor,
                                  Motion& moving) const {
  const Drive& drive = description_.drives[unknown];
  const auto g = receptance_.col(sensor);
  const Eigen::Map<const VectorXd> motion(moving.q, size_), speed(moving.rate, size_);
  const double beta = equations.stiffness_damping();
  switch (drive.kind) {
    case Drive::Kind::mass_damping:
      return -rows_.col(sensors_[sensor]).dot(speed);
    case Drive::Kind::stiffness_damping: {
      VectorXd product = VectorXd::Zero(size_);
      equations.stiffness().add_product(moving.rate, product.data());
      return -g.dot(product);
    }
    case Drive::Kind::damping_ratio: {
      double sum = 0.0;
      for (std::size_t i = 0; i < equations.damped_modes().size(); ++i) {
        const ModeDamping& mode = equations.mode_dampings()[i];
        if (equations.damped_modes()[i].unknown == unknown)
          sum -= mode.by_ratio * mode.momentum.dot(g) * mode.momentum.dot(speed);
      }
      return sum;
    }
    case Drive::Kind::property:
      break;
  }
  const Index j = drive.index;
  double sum = -equations.stiffness().slope_form(j, g.data(), moving.q);
  if (beta != 0.0) sum -= beta * equations.stiffness().slope_form(j, g.data(), moving.rate);
  if (equations.force_depends_on(j)) sum += g.dot(equations.force_slope(j, moving.input));
  sum -= equations.dashpots().slope(j).form(g.data(), moving.rate);
  for (std::size_t i = 0; i < equations.damped_modes().size(); ++i) {
    const ModeDamping& mode = equations.mode_dampings()[i];
    const auto slope = equations.damped_modes()[i].momentum_slopes.col(j);
    const double own = mode.momentum.dot(g), seen = mode.momentum.dot(speed);
    sum -= mode.by_property[j] * own * seen + mode.factor * (slope.dot(g) * seen + own * slope.dot(speed));
  }
  if (equations.mass().slope(j).empty()) return sum;
  const VectorXd& acceleration = accelerations(equations, moving);
  for (const BandedMass::Entry& entry : equations.mass().slope(j))
    sum -= g[entry.row] * entry.value * acceleration[entry.column];
  return sum;
}

// a + alpha q' = M^-1 (E f - K q - (C - alpha M) q') (n), where M_j has entries: C_j = alpha M_j takes the
// second term back.
const VectorXd& ContinuumSensors::accelerations(const BandedEquations& equations, Motion& moving) const {
  if (moving.accelerations.size() > 0) return moving.accelerations;
  const Eigen::Map<const VectorXd> motion(moving.q, size_), speed(moving.rate, size_);
  VectorXd force = VectorXd::Zero(size_);  // K q + (C - alpha M) q', then what accelerates
  const VectorXd strained = motion + equations.stiffness_damping() * speed;
  equations.stiffness().add_product(strained.data(), force.data());
  equations.dashpots().now().add_product(moving.rate, force.data());
  for (const ModeDamping& mode : equations.mode_dampings())
    force += mode.factor * mode.momentum.dot(speed) * mode.momentum;
  force = equations.force(moving.input) - force;
  if (mass_factor_) return moving.accelerations = mass_factor_->real_part_solved(force);
  moving.accelerations.setZero(size_);
  const std::vector<Index>& support = equations.mass().support();
  for (std::size_t i = 0; i < support.size(); ++i)
    moving.accelerations[support[i]] = receptance_.col(static_cast<Index>(sensors_.size() + i)).dot(force);
  return moving.accelerations;
}

void ContinuumSensors::jacobian(const BandedEquations& equations, const VectorXd& slopes,
                                const VectorXd& state, const VectorXd& input, MatrixXd& jacobian) const {
  jacobian.setZero(rows_.cols(), layout_.size);
  Motion moving{state.data(), state.data() + size_, input};
  Index k = 0;
  for (Index i = 0; i < rows_.cols(); ++i) {
    const Reads what = reads(description_.observations[i].quantity);
    if (what == Reads::coordinates) jacobian.row(i).head(size_) = rows_.col(i);
    if (what == Reads::rates) jacobian.row(i).segment(size_, size_) = rows_.col(i);
    if (what != Reads::accelerations) continue;
    jacobian.row(i).head(size_) = by_motion_.col(k);
    jacobian.row(i).segment(size_, size_) = by_rate_.col(k);
    for (Index u = 0; u < slopes.size(); ++u)
      jacobian(i, layout_.unknowns + u) = slopes[u] * by_drive(equations, u, k, moving);
    if (layout_.biases[i] >= 0) jacobian(i, layout_.biases[i]) = 1.0;
    ++k;
  }
}

}  // namespace beamid::experiments::banded
