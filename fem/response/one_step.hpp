// The implicit one-step methods of structural dynamics, all of them members of one family.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include "fem/response/method.hpp"
#include "fem/structural_system.hpp"

namespace beamid::fem {

// Cubic springs and quadratic dashpots in an implicit time step.

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

/// Generalised-alpha method [chung1993]: with d = q, v = q', a = q'' at both ends of a step h,
///
///     d_1 = d + h v + h^2 ((1/2 - beta) a + beta a_1),      v_1 = v + h ((1 - gamma) a + gamma a_1),
///     M a_m + C v_f + K d_f + g(d_f, v_f) = f_f,            x_m = (1 - alpha_m) x_1 + alpha_m x, x_f
///     likewise.
///
/// alpha_m = alpha_f = 0 is Newmark's method, alpha_m = 0 alone is HHT-alpha.
struct OneStepScheme {
  std::string name;            ///< for messages
  double mass_average = 0.0;   ///< alpha_m
  double force_average = 0.0;  ///< alpha_f
  double beta = 0.25, gamma = 0.5;
};

/// The motion by such a scheme; damping by the law's proportional matrix and the dashpots of the model.
/// Elastic forces go through the strain factors. Cubic springs and quadratic dashpots are solved by Newton's
/// method for their forces alone, the factored matrix staying as it is.
/// @throws std::invalid_argument for a law without a sparse matrix; std::runtime_error when Newton's method
/// does not converge, naming the time.
Response integrate(const ResponseProblem& problem, const OneStepScheme& scheme);

}  // namespace beamid::fem
