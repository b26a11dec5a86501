// Derivatives of what sensors read, by the state and by the unknowns.
#include <algorithm>

#include "experiments/models/banded/continuum_sensors.hpp"

namespace beamid::experiments::banded {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Of -g^T (C q' + K q) + g^T E f along one unknown, M g = h held: - g^T M_j a comes with g.
double ContinuumSensors::by_drive(const BandedEquations& equations, Index unknown, Index sensor,
                                  const double* q, const double* rate, const VectorXd& input) const {
  const Drive& drive = description_.drives[unknown];
  const auto g = receptance_.col(sensor);
  const Eigen::Map<const VectorXd> motion(q, size_), speed(rate, size_);
  const double beta = equations.stiffness_damping();
  switch (drive.kind) {
    case Drive::Kind::mass_damping:
      return -rows_.col(sensors_[sensor]).dot(speed);
    case Drive::Kind::stiffness_damping: {
      VectorXd product = VectorXd::Zero(size_);
      equations.stiffness().add_product(rate, product.data());
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
  double sum = -equations.stiffness().slope_form(j, g.data(), q);
  if (beta != 0.0) sum -= beta * equations.stiffness().slope_form(j, g.data(), rate);
  if (equations.force_depends_on(j)) sum += g.dot(equations.force_slope(j, input));
  for (std::size_t i = 0; i < equations.damped_modes().size(); ++i) {
    const ModeDamping& mode = equations.mode_dampings()[i];
    const auto slope = equations.damped_modes()[i].momentum_slopes.col(j);
    const double own = mode.momentum.dot(g), seen = mode.momentum.dot(speed);
    sum -= mode.by_property[j] * own * seen + mode.factor * (slope.dot(g) * seen + own * slope.dot(speed));
  }
  if (equations.mass().slope(j).empty()) return sum;

  // -g^T M_j (a + alpha q'), accelerations a being wanted only where M_j has entries. Of a, -alpha q' is what
  // C_j = alpha M_j takes back.
  VectorXd force = VectorXd::Zero(size_);  // K q + (C - alpha M) q', then what accelerates
  equations.stiffness().add_product(VectorXd(motion + beta * speed).data(), force.data());
  equations.add_dashpots(rate, force.data());
  for (const ModeDamping& mode : equations.mode_dampings())
    force += mode.factor * mode.momentum.dot(speed) * mode.momentum;
  force = equations.force(input) - force;
  const std::vector<Index>& support = equations.mass().support();
  for (const BandedMass::Entry& entry : equations.mass().slope(j)) {
    const Index place = std::lower_bound(support.begin(), support.end(), entry.column) - support.begin();
    const double acceleration = receptance_.col(static_cast<Index>(sensors_.size()) + place).dot(force);
    sum -= g[entry.row] * entry.value * acceleration;
  }
  return sum;
}

void ContinuumSensors::jacobian(const BandedEquations& equations, const VectorXd& slopes,
                                const VectorXd& state, const VectorXd& input, MatrixXd& jacobian) const {
  jacobian.setZero(rows_.cols(), layout_.size);
  Index k = 0;
  for (Index i = 0; i < rows_.cols(); ++i) {
    const Reads what = reads(description_.observations[i].quantity);
    if (what == Reads::coordinates) jacobian.row(i).head(size_) = rows_.col(i);
    if (what == Reads::rates) jacobian.row(i).segment(size_, size_) = rows_.col(i);
    if (what != Reads::accelerations) continue;
    jacobian.row(i).head(size_) = by_motion_.col(k);
    jacobian.row(i).segment(size_, size_) = by_rate_.col(k);
    for (Index u = 0; u < slopes.size(); ++u)
      jacobian(i, layout_.unknowns + u) =
          slopes[u] * by_drive(equations, u, k, state.data(), state.data() + size_, input);
    if (layout_.biases[i] >= 0) jacobian(i, layout_.biases[i]) = 1.0;
    ++k;
  }
}

}  // namespace beamid::experiments::banded
