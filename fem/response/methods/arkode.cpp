// SUNDIALS ARKODE: diagonally implicit Runge-Kutta methods of adaptive step [reynolds2023]. Stable for
// motions that are fast and lightly damped, which backward differentiation (cvode) is not.
#include "fem/response/sundials.hpp"

namespace beamid::fem {
namespace {

void require_arkode(int flag, const char* call, double time) {
  require_success(flag, "arkode", call, time, ARKodeGetReturnFlagName);
}

int linear_system(sunrealtype, N_Vector y, N_Vector, SUNMatrix matrix, SUNMatrix, sunbooleantype,
                  sunbooleantype* is_current, sunrealtype gamma, void* data, N_Vector, N_Vector, N_Vector) {
  *is_current = SUNTRUE;
  return SundialsMotion::set_matrix(matrix, gamma, y, data);
}

Response arkode(const ResponseProblem& problem, const ResponseOptions& options) {
  require_option("arkode", options, "tolerance", 1e-14, 0.1, "1e-14 to 0.1");
  require_option("arkode", options, "absolute_tolerance", 1e-300, 1.0, "above 0, to 1 m");
  require_option("arkode", options, "order", 2.0, 5.0, "2 to 5");
  SundialsMotion motion(problem, "arkode", options.at("absolute_tolerance"));
  struct Free {
    void operator()(void* memory) const { ARKodeFree(&memory); }
  };
  const std::unique_ptr<void, Free> memory(
      ARKStepCreate(nullptr, SundialsMotion::rate, 0.0, motion.state.get(), motion.context.get()));
  if (!memory) throw std::bad_alloc();
  require_arkode(silence_arkode(memory.get(), motion.context.get()), "silence_arkode", 0.0);
  require_arkode(ARKodeSetUserData(memory.get(), &motion), "ARKodeSetUserData", 0.0);
  require_arkode(ARKodeSetOrder(memory.get(), static_cast<int>(options.at("order"))), "ARKodeSetOrder", 0.0);
  require_arkode(ARKodeSVtolerances(memory.get(), options.at("tolerance"), motion.absolute_tolerances.get()),
                 "ARKodeSVtolerances", 0.0);
  require_arkode(ARKodeSetLinearSolver(memory.get(), motion.solver.get(), motion.matrix.get()),
                 "ARKodeSetLinearSolver", 0.0);
  require_arkode(ARKodeSetLinSysFn(memory.get(), linear_system), "ARKodeSetLinSysFn", 0.0);
  if (motion.equations.is_linear()) require_arkode(ARKodeSetLinear(memory.get(), 0), "ARKodeSetLinear", 0.0);
  require_arkode(ARKodeSetMaxNumSteps(memory.get(), 1000000), "ARKodeSetMaxNumSteps", 0.0);
  if (problem.has_inputs())  // else it could step across a short pulse
    require_arkode(ARKodeSetMaxStep(memory.get(), problem.grid.interval), "ARKodeSetMaxStep", 0.0);

  return motion.follow(problem, [&](double time) {
    sunrealtype reached = 0.0;
    if (problem.has_inputs())  // they have a kink there, which no step may cross
      require_arkode(ARKodeSetStopTime(memory.get(), time), "ARKodeSetStopTime", time);
    require_arkode(ARKodeEvolve(memory.get(), time, motion.state.get(), &reached, ARK_NORMAL), "ARKodeEvolve",
                   time);
    require_arkode(ARKodeGetDky(memory.get(), time, 1, motion.work.get()), "ARKodeGetDky", time);
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
