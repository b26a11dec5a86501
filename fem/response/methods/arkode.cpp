// SUNDIALS ARKODE: diagonally implicit Runge-Kutta methods of adaptive step [reynolds2023]. Stable for
// motions that are fast and lightly damped, which backward differentiation (cvode) is not.
#include <arkode/arkode_arkstep.h>

#include "fem/response/sundials.hpp"

namespace beamid::fem {
namespace {

void require_arkode(int flag, const char* call, double time) {
  require_success(flag, "arkode", call, time, ARKStepGetReturnFlagName);
}

int linear_system(realtype, N_Vector y, N_Vector, SUNMatrix matrix, SUNMatrix, booleantype,
                  booleantype* is_current, realtype gamma, void* data, N_Vector, N_Vector, N_Vector) {
  *is_current = SUNTRUE;
  return SundialsMotion::set_matrix(matrix, gamma, y, data);
}

Response arkode(const ResponseProblem& problem, const ResponseOptions& options) {
  require_option("arkode", options, "tolerance", 1e-14, 0.1, "1e-14 to 0.1");
  require_option("arkode", options, "absolute_tolerance", 1e-300, 1.0, "above 0, to 1 m");
  require_option("arkode", options, "order", 2.0, 5.0, "2 to 5");
  SundialsMotion motion(problem, "arkode", options.at("absolute_tolerance"));
  struct Free {
    void operator()(void* memory) const { ARKStepFree(&memory); }
  };
  const std::unique_ptr<void, Free> memory(
      ARKStepCreate(nullptr, SundialsMotion::rate, 0.0, motion.state.get(), motion.context.get()));
  if (!memory) throw std::bad_alloc();
  require_arkode(ARKStepSetErrFile(memory.get(), nullptr), "ARKStepSetErrFile",
                 0.0);  // failures are thrown, not printed
  require_arkode(ARKStepSetUserData(memory.get(), &motion), "ARKStepSetUserData", 0.0);
  require_arkode(ARKStepSetOrder(memory.get(), static_cast<int>(options.at("order"))), "ARKStepSetOrder",
                 0.0);
  require_arkode(ARKStepSVtolerances(memory.get(), options.at("tolerance"), motion.absolute_tolerances.get()),
                 "ARKStepSVtolerances", 0.0);
  require_arkode(ARKStepSetLinearSolver(memory.get(), motion.solver.get(), motion.matrix.get()),
                 "ARKStepSetLinearSolver", 0.0);
  require_arkode(ARKStepSetLinSysFn(memory.get(), linear_system), "ARKStepSetLinSysFn", 0.0);
  if (motion.equations.is_linear())
    require_arkode(ARKStepSetLinear(memory.get(), 0), "ARKStepSetLinear", 0.0);
  require_arkode(ARKStepSetMaxNumSteps(memory.get(), 1000000), "ARKStepSetMaxNumSteps", 0.0);
  if (problem.has_inputs())  // else it could step across a short pulse
    require_arkode(ARKStepSetMaxStep(memory.get(), problem.grid.interval), "ARKStepSetMaxStep", 0.0);

  return motion.follow(problem, [&](double time) {
    realtype reached = 0.0;
    if (problem.has_inputs())  // they have a kink there, which no step may cross
      require_arkode(ARKStepSetStopTime(memory.get(), time), "ARKStepSetStopTime", time);
    require_arkode(ARKStepEvolve(memory.get(), time, motion.state.get(), &reached, ARK_NORMAL),
                   "ARKStepEvolve", time);
    require_arkode(ARKStepGetDky(memory.get(), time, 1, motion.work.get()), "ARKStepGetDky", time);
  });
}

const bool arkode_registered = register_response_method(
    {"arkode",
     "adaptive, implicit Runge-Kutta (SUNDIALS ARKODE, KLU); for nonlinear structures",
     "[reynolds2023], [davis2010]",
     {{"tolerance", 1e-8, "", "relative error allowed per step"},
      {"absolute_tolerance", 1e-10, "m",
       "absolute error allowed per step; of velocities, as much per interval"},
      {"order", 5.0, "", "of the method, 2 to 5"}}},
    arkode);

}  // namespace
}  // namespace beamid::fem
