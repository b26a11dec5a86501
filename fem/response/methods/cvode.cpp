// SUNDIALS CVODE: backward differentiation formulas of variable order and step [hindmarsh2005]. Of third
// order and above they are unstable for motions that are fast and lightly damped, which is what the high
// modes of a beam are: CVODE then has to follow every one of them. Meant for damped structures and as a
// second opinion; see arkode. The solver comes from CVODES, which has it whole: a program must not link both.
#include <algorithm>

#include "fem/response/sundials.hpp"

namespace beamid::fem {
namespace {

void require_cvode(int flag, const char* call, double time) {
  require_success(flag, "cvode", call, time, CVodeGetReturnFlagName);
}

int linear_system(sunrealtype, N_Vector y, N_Vector, SUNMatrix matrix, sunbooleantype,
                  sunbooleantype* is_current, sunrealtype gamma, void* data, N_Vector, N_Vector, N_Vector) {
  *is_current = SUNTRUE;
  return SundialsMotion::set_matrix(matrix, gamma, y, data);
}

Response cvode(const ResponseProblem& problem, const ResponseOptions& options) {
  require_option("cvode", options, "tolerance", 1e-14, 0.1, "1e-14 to 0.1");
  require_option("cvode", options, "absolute_tolerance", 1e-300, 1.0, "above 0, to 1 m");
  require_option("cvode", options, "order", 1.0, 5.0, "1 to 5");
  // Behind the kink of the inputs at every sample the formulas begin anew, with short steps of low order,
  // whose errors add up.
  const double share = problem.has_inputs() ? 0.03 : 1.0;
  SundialsMotion motion(problem, "cvode", share * options.at("absolute_tolerance"));
  struct Free {
    void operator()(void* memory) const { CVodeFree(&memory); }
  };
  const std::unique_ptr<void, Free> memory(CVodeCreate(CV_BDF, motion.context.get()));
  if (!memory) throw std::bad_alloc();
  require_cvode(silence_cvode(memory.get(), motion.context.get()), "silence_cvode", 0.0);
  require_cvode(CVodeInit(memory.get(), SundialsMotion::rate, 0.0, motion.state.get()), "CVodeInit", 0.0);
  require_cvode(CVodeSetUserData(memory.get(), &motion), "CVodeSetUserData", 0.0);
  require_cvode(CVodeSVtolerances(memory.get(), std::max(share * options.at("tolerance"), 1e-14),
                                  motion.absolute_tolerances.get()),
                "CVodeSVtolerances", 0.0);
  require_cvode(CVodeSetLinearSolver(memory.get(), motion.solver.get(), motion.matrix.get()),
                "CVodeSetLinearSolver", 0.0);
  require_cvode(CVodeSetLinSysFn(memory.get(), linear_system), "CVodeSetLinSysFn", 0.0);
  require_cvode(CVodeSetMaxOrd(memory.get(), static_cast<int>(options.at("order"))), "CVodeSetMaxOrd", 0.0);
  require_cvode(CVodeSetMaxNumSteps(memory.get(), 1000000), "CVodeSetMaxNumSteps", 0.0);
  if (problem.has_inputs())  // else it could step across a short pulse
    require_cvode(CVodeSetMaxStep(memory.get(), problem.grid.interval), "CVodeSetMaxStep", 0.0);

  Response response = motion.follow(problem, [&](double time) {
    sunrealtype reached = 0.0;
    if (problem.has_inputs())  // they have a kink there, which neither steps nor formulas may cross
      require_cvode(CVodeSetStopTime(memory.get(), time), "CVodeSetStopTime", time);
    require_cvode(CVode(memory.get(), time, motion.state.get(), &reached, CV_NORMAL), "CVode", time);
    require_cvode(CVodeGetDky(memory.get(), time, 1, motion.work.get()), "CVodeGetDky", time);
    if (problem.has_inputs())
      require_cvode(CVodeReInit(memory.get(), time, motion.state.get()), "CVodeReInit", time);
  });
  response.remarks.emplace_back(
      "cvode: accelerations are those of its interpolating polynomial and can err far more than "
      "displacements; compare them with arkode");
  return response;
}

const bool cvode_registered = register_response_method(
    {"cvode",
     "adaptive, backward differentiation (SUNDIALS CVODE, KLU); for strong damping, slow otherwise",
     "[hindmarsh2005], [davis2010]",
     {{"tolerance", 1e-8, "", "relative error allowed per step"},
      {"absolute_tolerance", 1e-10, "m",
       "absolute error allowed per step; of velocities, as much per interval"},
      {"order", 5.0, "", "highest order used, 1 to 5; 2 is stable for undamped motions"}}},
    cvode);

}  // namespace
}  // namespace beamid::fem
