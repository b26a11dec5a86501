// SUNDIALS 6 (Debian 12) and 7 (Debian 13) under the names of 7. Everything in which they differ for fem is
// here, and in fem/sundials.cmake.
#pragma once

#include <arkode/arkode_arkstep.h>
#include <cvodes/cvodes.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>

namespace beamid::fem {

#if SUNDIALS_VERSION_MAJOR < 7

inline int create_sundials_context(SUNContext* context) {
  return SUNContext_Create(nullptr, context);
}

// Failures are thrown, not printed: 6 is told so by integrator, 7 by context.
inline int silence_cvode(void* memory, SUNContext) {
  return CVodeSetErrFile(memory, nullptr);
}
inline int silence_arkode(void* memory, SUNContext) {
  return ARKStepSetErrFile(memory, nullptr);
}

inline void ARKodeFree(void** memory) {
  ARKStepFree(memory);
}
constexpr auto ARKodeGetReturnFlagName = ARKStepGetReturnFlagName;
constexpr auto ARKodeSetUserData = ARKStepSetUserData;
constexpr auto ARKodeSetOrder = ARKStepSetOrder;
constexpr auto ARKodeSVtolerances = ARKStepSVtolerances;
constexpr auto ARKodeSetLinearSolver = ARKStepSetLinearSolver;
constexpr auto ARKodeSetLinSysFn = ARKStepSetLinSysFn;
constexpr auto ARKodeSetLinear = ARKStepSetLinear;
constexpr auto ARKodeSetMaxNumSteps = ARKStepSetMaxNumSteps;
constexpr auto ARKodeSetMaxStep = ARKStepSetMaxStep;
constexpr auto ARKodeSetStopTime = ARKStepSetStopTime;
constexpr auto ARKodeEvolve = ARKStepEvolve;
constexpr auto ARKodeGetDky = ARKStepGetDky;

#else

inline int create_sundials_context(SUNContext* context) {
  const int flag = SUNContext_Create(SUN_COMM_NULL, context);
  return flag != 0 ? flag : SUNContext_ClearErrHandlers(*context);
}

inline int silence_cvode(void*, SUNContext context) {
  return SUNContext_ClearErrHandlers(context);
}
inline int silence_arkode(void*, SUNContext context) {
  return SUNContext_ClearErrHandlers(context);
}

#endif

}  // namespace beamid::fem
