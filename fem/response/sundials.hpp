// SUNDIALS objects that free themselves, and the Newton matrix of the equations of motion for its
// integrators.
#pragma once

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include <functional>
#include <memory>
#include <string>
#include <type_traits>

#include "fem/response/motion_equations.hpp"

namespace beamid::fem {

struct SundialsDeleter {
  void operator()(SUNContext context) const { SUNContext_Free(&context); }
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
  void operator()(SUNMatrix matrix) const { SUNMatDestroy(matrix); }
  void operator()(SUNLinearSolver solver) const { SUNLinSolFree(solver); }
};
template <class Handle>
using Sundials = std::unique_ptr<std::remove_pointer_t<Handle>, SundialsDeleter>;

inline Eigen::Map<Eigen::VectorXd> view(N_Vector vector) {
  return {N_VGetArrayPointer(vector), static_cast<Eigen::Index>(N_VGetLength(vector))};
}

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
