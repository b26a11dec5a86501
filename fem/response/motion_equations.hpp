// The equations of motion as adaptive integrators want them.
#pragma once

#include <Eigen/Core>

#include "fem/response/diagonal_product.hpp"
#include "fem/response/method.hpp"
#include "fem/response/point_forces.hpp"
#include "fem/response/strain_force.hpp"
#include "fem/response/symmetric_factor.hpp"

namespace beamid::fem {

/// y = (q, q') (2n),  y' = (q', M^-1 (E f(t) - C q' - K q - g)), and what Newton's method needs to solve
/// (I - gamma dy'/dy) x = b. With x = (x_1, x_2) the first half gives x_1 = b_1 + gamma x_2 and the second
///
///     (M + gamma C_t + gamma^2 K_t) x_2 = M b_2 - gamma K_t b_1,
///
/// a matrix as sparse as K, where M^-1 K is full; C_t and K_t are the tangents, point forces included.
class MotionEquations {
 public:
  /// @throws std::invalid_argument, naming the method, for a law without a sparse matrix.
  MotionEquations(const ResponseProblem& problem, const std::string& method);

  Eigen::Index size() const { return problem_.system.size(); }  ///< n
  bool is_linear() const { return points_.empty(); }
  Eigen::VectorXd initial_state() const;

  /// y' (2n) at t, inputs linear between the samples.
  void rate(double t, const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::Ref<Eigen::VectorXd> y_rate);

  /// Takes gamma and the tangents at y for what follows; the matrix on the left, always of the same pattern.
  const SparseMatrix& effective_matrix(double gamma, const Eigen::Ref<const Eigen::VectorXd>& y);

  /// The right side of the equation for x_2 (n) from b (2n).
  const Eigen::VectorXd& reduce(const Eigen::Ref<const Eigen::VectorXd>& b);

  double gamma() const { return gamma_; }

 private:
  const ResponseProblem& problem_;
  ProportionalDamping law_;
  SparseMatrix damping_, stiffness_, pattern_, effective_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> inputs_;
  DiagonalProduct mass_, dashpots_;
  StrainForce elastic_;
  SymmetricFactor mass_factor_;
  PointForces points_;
  double gamma_ = 0.0;
  Eigen::VectorXd point_stiffness_, point_damping_;  // tangents (r)
  Eigen::VectorXd q_, v_, force_, weighted_, right_;
};

}  // namespace beamid::fem
