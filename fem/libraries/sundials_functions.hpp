// The functions of SUNDIALS that fem and filters use, loaded when an integrator of it is first used: Debian
// 13 builds SUNDIALS with MPI, and a program that links it starts a tenth of a second later. SUNDIALS 6
// (Debian 12) and 7 (Debian 13) under the names of 7: all in which they differ is here and in sundials.cmake.
#pragma once

#include <arkode/arkode_arkstep.h>
#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#include <Eigen/Core>

#include <needed_library.hpp>

namespace beamid {

// CVODES and not CVODE: it has the sensitivities that filters need, and both define the same functions.
inline constexpr NeededLibrary sundials_cvodes{BEAMID_CVODES}, sundials_arkode{BEAMID_ARKODE},
    sundials_klu{BEAMID_SUNLINSOLKLU};

BEAMID_NEEDED(sundials_cvodes, SUNContext_Create);
BEAMID_NEEDED(sundials_cvodes, SUNContext_Free);

BEAMID_NEEDED(sundials_cvodes, N_VCloneVectorArray);
BEAMID_NEEDED(sundials_cvodes, N_VDestroy);
BEAMID_NEEDED(sundials_cvodes, N_VDestroyVectorArray);
BEAMID_NEEDED(sundials_cvodes, N_VGetArrayPointer);
BEAMID_NEEDED(sundials_cvodes, N_VGetLength);
BEAMID_NEEDED(sundials_cvodes, N_VNew_Serial);

BEAMID_NEEDED(sundials_cvodes, SUNMatDestroy);
BEAMID_NEEDED(sundials_cvodes, SUNSparseMatrix);
BEAMID_NEEDED(sundials_cvodes, SUNSparseMatrix_Data);
BEAMID_NEEDED(sundials_cvodes, SUNSparseMatrix_IndexPointers);
BEAMID_NEEDED(sundials_cvodes, SUNSparseMatrix_IndexValues);
BEAMID_NEEDED(sundials_cvodes, SUNSparseMatrix_NNZ);

BEAMID_NEEDED(sundials_cvodes, SUNLinSolFree);
BEAMID_NEEDED(sundials_cvodes, SUNLinSolFreeEmpty);
BEAMID_NEEDED(sundials_cvodes, SUNLinSolInitialize);
BEAMID_NEEDED(sundials_cvodes, SUNLinSolNewEmpty);
BEAMID_NEEDED(sundials_cvodes, SUNLinSolSetup);
BEAMID_NEEDED(sundials_cvodes, SUNLinSolSolve);

BEAMID_NEEDED(sundials_cvodes, SUNNonlinSolFree);
BEAMID_NEEDED(sundials_cvodes, SUNNonlinSol_FixedPoint);
BEAMID_NEEDED(sundials_cvodes, SUNNonlinSol_FixedPointSens);

BEAMID_NEEDED(sundials_cvodes, CVode);
BEAMID_NEEDED(sundials_cvodes, CVodeCreate);
BEAMID_NEEDED(sundials_cvodes, CVodeFree);
BEAMID_NEEDED(sundials_cvodes, CVodeGetDky);
BEAMID_NEEDED(sundials_cvodes, CVodeGetReturnFlagName);
BEAMID_NEEDED(sundials_cvodes, CVodeGetSens);
BEAMID_NEEDED(sundials_cvodes, CVodeInit);
BEAMID_NEEDED(sundials_cvodes, CVodeReInit);
BEAMID_NEEDED(sundials_cvodes, CVodeSStolerances);
BEAMID_NEEDED(sundials_cvodes, CVodeSVtolerances);
BEAMID_NEEDED(sundials_cvodes, CVodeSensEEtolerances);
BEAMID_NEEDED(sundials_cvodes, CVodeSensInit);
BEAMID_NEEDED(sundials_cvodes, CVodeSensReInit);
BEAMID_NEEDED(sundials_cvodes, CVodeSensToggleOff);
BEAMID_NEEDED(sundials_cvodes, CVodeSetLinSysFn);
BEAMID_NEEDED(sundials_cvodes, CVodeSetLinearSolver);
BEAMID_NEEDED(sundials_cvodes, CVodeSetMaxNumSteps);
BEAMID_NEEDED(sundials_cvodes, CVodeSetMaxOrd);
BEAMID_NEEDED(sundials_cvodes, CVodeSetMaxStep);
BEAMID_NEEDED(sundials_cvodes, CVodeSetNonlinearSolver);
BEAMID_NEEDED(sundials_cvodes, CVodeSetNonlinearSolverSensStg);
BEAMID_NEEDED(sundials_cvodes, CVodeSetSensErrCon);
BEAMID_NEEDED(sundials_cvodes, CVodeSetStopTime);
BEAMID_NEEDED(sundials_cvodes, CVodeSetUserData);
BEAMID_NEEDED(sundials_klu, SUNLinSol_KLU);

BEAMID_NEEDED(sundials_arkode, ARKStepCreate);

#if SUNDIALS_VERSION_MAJOR < 7
#define BEAMID_ARKODE_FUNCTION(name)                                                             \
  inline constinit const NeededFunction<decltype(::ARKStep##name)> ARKode##name(sundials_arkode, \
                                                                                "ARKStep" #name)
BEAMID_NEEDED(sundials_cvodes, CVodeSetErrFile);
BEAMID_ARKODE_FUNCTION(SetErrFile);
#else
#define BEAMID_ARKODE_FUNCTION(name) BEAMID_NEEDED(sundials_arkode, ARKode##name)
BEAMID_NEEDED(sundials_cvodes, SUNContext_ClearErrHandlers);
#ifdef OPEN_MPI  // what SUN_COMM_NULL stands for
BEAMID_NEEDED_VARIABLE(sundials_cvodes, ompi_mpi_comm_null);
#endif
#endif
BEAMID_ARKODE_FUNCTION(Free);
BEAMID_ARKODE_FUNCTION(GetReturnFlagName);
BEAMID_ARKODE_FUNCTION(SetUserData);
BEAMID_ARKODE_FUNCTION(SetOrder);
BEAMID_ARKODE_FUNCTION(SVtolerances);
BEAMID_ARKODE_FUNCTION(SetLinearSolver);
BEAMID_ARKODE_FUNCTION(SetLinSysFn);
BEAMID_ARKODE_FUNCTION(SetLinear);
BEAMID_ARKODE_FUNCTION(SetMaxNumSteps);
BEAMID_ARKODE_FUNCTION(SetMaxStep);
BEAMID_ARKODE_FUNCTION(SetStopTime);
BEAMID_ARKODE_FUNCTION(Evolve);
BEAMID_ARKODE_FUNCTION(GetDky);
#undef BEAMID_ARKODE_FUNCTION

#if SUNDIALS_VERSION_MAJOR < 7

inline int create_sundials_context(SUNContext* context) {
  return SUNContext_Create(nullptr, context);
}

// Failures are thrown, not printed: 6 is silenced by integrator, 7 by context.
inline int silence_cvode(void* memory, SUNContext) {
  return CVodeSetErrFile(memory, nullptr);
}
inline int silence_arkode(void* memory, SUNContext) {
  return ARKodeSetErrFile(memory, nullptr);
}

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

inline Eigen::Map<Eigen::VectorXd> view(N_Vector vector) {
  return {N_VGetArrayPointer(vector), static_cast<Eigen::Index>(N_VGetLength(vector))};
}

}  // namespace beamid
