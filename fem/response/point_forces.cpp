#include "fem/response/point_forces.hpp"

#include <limits>

namespace beamid::fem {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

PointForces::PointForces(const std::vector<NonlinearForce>& forces) {
  const auto count = static_cast<Index>(forces.size());
  if (count == 0) return;
  directions_.resize(forces.front().direction.rows(), count);
  cubic_.resize(count);
  quadratic_.resize(count);
  for (Index j = 0; j < count; ++j) {
    directions_.col(j) = forces[j].direction;
    cubic_[j] = forces[j].cubic_stiffness;
    quadratic_[j] = forces[j].quadratic_damping;
  }
}

VectorXd PointForces::force(const VectorXd& x, const VectorXd& rate) const {
  return cubic_.cwiseProduct(x).cwiseProduct(x.cwiseAbs2()) +
         quadratic_.cwiseProduct(rate).cwiseProduct(rate.cwiseAbs());
}

void PointForces::subtract(const VectorXd& q, const VectorXd& velocity, VectorXd& force) const {
  if (empty()) return;
  force -= directions_ * this->force(directions_.transpose() * q, directions_.transpose() * velocity);
}

bool PointForces::solve(const VectorXd& x, const VectorXd& rate, double a, double b,
                        const MatrixXd& flexibility, VectorXd& guess) const {
  constexpr double rounding = 8.0 * std::numeric_limits<double>::epsilon();
  for (int iteration = 0; iteration < 50; ++iteration) {
    const VectorXd moved = flexibility * guess, at = x - a * moved, speed = rate - b * moved;
    const VectorXd target = force(at, speed), residual = target - guess;
    MatrixXd slope = (a * stiffness(at) + b * damping(speed)).asDiagonal() * flexibility;
    slope.diagonal().array() += 1.0;
    const VectorXd change = slope.partialPivLu().solve(residual);
    if (!change.allFinite()) return false;
    guess += change;
    if (change.norm() <= rounding * (guess.norm() + target.norm())) return true;
  }
  return false;
}

}  // namespace beamid::fem
