// Cubic springs and quadratic dashpots in an implicit time step.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "fem/structural_system.hpp"

namespace beamid::fem {

/// g_j = k3 x^3 + c2 |x'| x' at x = c_j^T q, r of them; they act on the structure as -sum_j c_j g_j.
class PointForces {
 public:
  explicit PointForces(const std::vector<NonlinearForce>& forces);

  bool empty() const { return cubic_.size() == 0; }
  const Eigen::MatrixXd& directions() const { return directions_; }  ///< c (n x r)

  /// g (r) at the displacements x and velocities x' (r) of the points.
  Eigen::VectorXd force(const Eigen::VectorXd& x, const Eigen::VectorXd& rate) const;

  /// dg_j/dx_j and dg_j/dx'_j (r): every force depends on its own point only.
  Eigen::VectorXd stiffness(const Eigen::VectorXd& x) const {
    return 3.0 * cubic_.cwiseProduct(x.cwiseAbs2());
  }
  Eigen::VectorXd damping(const Eigen::VectorXd& rate) const {
    return 2.0 * quadratic_.cwiseProduct(rate.cwiseAbs());
  }

  /// Force -= sum_j c_j g_j of the motion q, q' (n).
  void subtract(const Eigen::VectorXd& q, const Eigen::VectorXd& velocity, Eigen::VectorXd& force) const;

  /// The g that satisfies g = force(x - a G g, x' - b G g), by Newton's method from `guess`: a time step in
  /// which the points would reach x, x' without the forces, and G is what a unit of each does to them.
  /// @returns false when it does not converge.
  bool solve(const Eigen::VectorXd& x, const Eigen::VectorXd& rate, double a, double b,
             const Eigen::MatrixXd& flexibility, Eigen::VectorXd& guess) const;

 private:
  Eigen::MatrixXd directions_;
  Eigen::VectorXd cubic_, quadratic_;  // k3, c2 (r)
};

}  // namespace beamid::fem
