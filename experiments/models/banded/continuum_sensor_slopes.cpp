// Derivatives of what sensors read, by the state and by the unknowns.
#include "experiments/models/banded/continuum_sensors.hpp"

namespace beamid::experiments::banded {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

struct ContinuumSensors::Motion {
  const double *q, *rate;
  const VectorXd& input;
  VectorXd modes = {};  // g_i^T q' of the damped modes
  VectorXd accelerations = {};

  Eigen::Map<const VectorXd> speed(Index size) const { return {rate, size}; }
};

// Of -g^T (C q' + K q) + g^T E f along one unknown, for every sensor (k), M g = h held: - g^T M_j a comes
// with g.
VectorXd ContinuumSensors::by_drive(const BandedEquations& equations, Index unknown, Motion& moving) const {
  const Drive& drive = description_.drives[unknown];
  const auto k = static_cast<Index>(sensors_.size());
  VectorXd sum = VectorXd::Zero(k);
  switch (drive.kind) {
    case Drive::Kind::mass_damping:
      for (Index i = 0; i < k; ++i) sum[i] = -rows_.col(sensors_[i]).dot(moving.speed(size_));
      return sum;
    case Drive::Kind::stiffness_damping: {
      VectorXd product = VectorXd::Zero(size_);
      equations.stiffness().add_product(moving.rate, product.data());
      return -receptance_.leftCols(k).transpose() * product;
    }
    case Drive::Kind::damping_ratio:
      for (std::size_t i = 0; i < equations.damped_modes().size(); ++i)
        if (equations.damped_modes()[i].unknown == unknown)
          sum -= equations.mode_dampings()[i].by_ratio * moving.modes[static_cast<Index>(i)] *
                 modes_seen_.row(static_cast<Index>(i)).transpose();
      return sum;
    case Drive::Kind::property:
      break;
  }
  return by_property(equations, drive.index, moving);
}

VectorXd ContinuumSensors::by_property(const BandedEquations& equations, Index j, Motion& moving) const {
  const auto k = static_cast<Index>(sensors_.size());
  const auto receptance = receptance_.leftCols(k);
  const double beta = equations.stiffness_damping();
  VectorXd sum = VectorXd::Zero(k);
  for (std::size_t b = 0; b < receptance_lanes_.size(); ++b) {
    const Lanes* const g = receptance_lanes_[b].data();
    Lanes four, of_rates;
    equations.stiffness().add_slope_form(j, g, moving.q, four);
    if (beta != 0.0) equations.stiffness().add_slope_form(j, g, moving.rate, of_rates);
    four += beta * of_rates;
    equations.dashpots().slope(j).add_form(g, moving.rate, four);
    const Index first = static_cast<Index>(b) * Lanes::count;
    for (Index l = 0; l < std::min<Index>(Lanes::count, k - first); ++l) sum[first + l] = -four.values[l];
  }
  if (equations.force_depends_on(j)) sum += receptance.transpose() * equations.force_slope(j, moving.input);
  const std::vector<BandedMass::Entry>& masses = equations.mass().slope(j);
  for (Index i = 0; i < modes_seen_.rows(); ++i) {
    const ModeDamping& mode = equations.mode_dampings()[static_cast<std::size_t>(i)];
    const VectorXd own = modes_seen_.row(i);
    sum -= mode.by_property[j] * moving.modes[i] * own;
    if (masses.empty()) continue;  // nor does the momentum change then
    const auto slope = equations.damped_modes()[static_cast<std::size_t>(i)].momentum_slopes.col(j);
    sum -= mode.factor *
           (moving.modes[i] * (receptance.transpose() * slope) + slope.dot(moving.speed(size_)) * own);
  }
  if (masses.empty()) return sum;
  const VectorXd& acceleration = accelerations(equations, moving);
  for (const BandedMass::Entry& entry : masses)
    sum -= entry.value * acceleration[entry.column] * receptance.row(entry.row).transpose();
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
  const auto k = static_cast<Index>(sensors_.size());
  for (Index i = 0; i < rows_.cols(); ++i) {
    const Reads what = reads(description_.observations[i].quantity);
    if (what == Reads::coordinates) jacobian.row(i).head(size_) = rows_.col(i);
    if (what == Reads::rates) jacobian.row(i).segment(size_, size_) = rows_.col(i);
    if (layout_.biases[i] >= 0) jacobian(i, layout_.biases[i]) = 1.0;
  }
  if (k == 0) return;
  for (Index c = 0; c < size_; ++c)  // column after column, as it is stored
    for (Index sensor = 0; sensor < k; ++sensor) {
      jacobian(sensors_[sensor], c) = by_motion_(c, sensor);
      jacobian(sensors_[sensor], size_ + c) = by_rate_(c, sensor);
    }
  Motion moving{state.data(), state.data() + size_, input};
  moving.modes.resize(modes_seen_.rows());
  for (Index i = 0; i < moving.modes.size(); ++i)
    moving.modes[i] =
        equations.mode_dampings()[static_cast<std::size_t>(i)].momentum.dot(moving.speed(size_));
  for (Index u = 0; u < slopes.size(); ++u)
    jacobian(sensors_, layout_.unknowns + u) = slopes[u] * by_drive(equations, u, moving);
}

}  // namespace beamid::experiments::banded
