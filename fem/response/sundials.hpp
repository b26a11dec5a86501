// SUNDIALS objects that free themselves, and the Newton matrix of the equations of motion for its
// integrators.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <type_traits>

#include <Eigen/Core>
#include <sundials_functions.hpp>

#include "fem/response/method.hpp"
#include "fem/response/one_step.hpp"
#include "fem/response/symmetric_factor.hpp"

namespace beamid::fem {

// The equations of motion as adaptive integrators want them.

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

struct SundialsDeleter {
  void operator()(SUNContext context) const { SUNContext_Free(&context); }
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
  void operator()(SUNMatrix matrix) const { SUNMatDestroy(matrix); }
  void operator()(SUNLinearSolver solver) const { SUNLinSolFree(solver); }
};
template <class Handle>
using Sundials = std::unique_ptr<std::remove_pointer_t<Handle>, SundialsDeleter>;

/// What CVODE and ARKODE share: state, tolerances, and a linear solver that reduces (I - gamma J) x = b to
/// the n unknowns of MotionEquations and factors that matrix by KLU [davis2010].
class SundialsMotion {
 public:
  /// @param absolute allowed error of the coordinates [m]; that of their velocities is as much per interval.
  SundialsMotion(const ResponseProblem& problem, const std::string& method, double absolute);

  MotionEquations equations;
  Sundials<SUNContext> context;
  Sundials<N_Vector> state, absolute_tolerances, work;
  Sundials<SUNMatrix> matrix;  ///< M + gamma C + gamma^2 K (n x n)
  Sundials<SUNLinearSolver> solver;

  /// Records the motion at every sample of the problem. `advance(time)` takes `state` there and leaves in
  /// `work` the derivative of the interpolating polynomial, for the acceleration: M^-1 (...) of a state with
  /// errors would magnify them by the square of the mesh's highest frequency.
  Response follow(const ResponseProblem& problem, const std::function<void(double)>& advance);

  /// The callbacks; `data` is this object.
  static int rate(sunrealtype t, N_Vector y, N_Vector y_rate, void* data);
  static int set_matrix(SUNMatrix matrix, sunrealtype gamma, N_Vector y, void* data);

 private:
  struct Klu;  // content of the linear solver
};

/// Throws std::runtime_error "cvode: CVode failed at 0.3 s: CV_TOO_MUCH_WORK" when a call did not succeed.
/// @param flag_name from CVodeGetReturnFlagName or its like; freed here.
void require_success(int flag, const std::string& method, const char* call, double time,
                     char* (*flag_name)(long int));

}  // namespace beamid::fem
