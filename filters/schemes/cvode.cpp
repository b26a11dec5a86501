// Adaptive integration over each step by SUNDIALS CVODES (Adams), the tangent by forward sensitivities:
// dS/dt = J(z) S, S(0) = I [hindmarsh2005]. For nonlinear motion, and the check of every other scheme.
#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "filters/needed_library.hpp"
#include "filters/scheme.hpp"
#include "filters/step_input.hpp"

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr NeededLibrary cvodes{BEAMID_CVODES};  // loaded when this scheme is first used
BEAMID_NEEDED(cvodes, CVode);
BEAMID_NEEDED(cvodes, CVodeCreate);
BEAMID_NEEDED(cvodes, CVodeFree);
BEAMID_NEEDED(cvodes, CVodeGetReturnFlagName);
BEAMID_NEEDED(cvodes, CVodeGetSens);
BEAMID_NEEDED(cvodes, CVodeInit);
BEAMID_NEEDED(cvodes, CVodeReInit);
BEAMID_NEEDED(cvodes, CVodeSStolerances);
BEAMID_NEEDED(cvodes, CVodeSensEEtolerances);
BEAMID_NEEDED(cvodes, CVodeSensInit);
BEAMID_NEEDED(cvodes, CVodeSensReInit);
BEAMID_NEEDED(cvodes, CVodeSensToggleOff);
BEAMID_NEEDED(cvodes, CVodeSetNonlinearSolver);
BEAMID_NEEDED(cvodes, CVodeSetNonlinearSolverSensStg);
BEAMID_NEEDED(cvodes, CVodeSetSensErrCon);
BEAMID_NEEDED(cvodes, CVodeSetStopTime);
BEAMID_NEEDED(cvodes, CVodeSetUserData);
BEAMID_NEEDED(cvodes, N_VCloneVectorArray);
BEAMID_NEEDED(cvodes, N_VDestroy);
BEAMID_NEEDED(cvodes, N_VDestroyVectorArray);
BEAMID_NEEDED(cvodes, N_VGetArrayPointer);
BEAMID_NEEDED(cvodes, N_VGetLength);
BEAMID_NEEDED(cvodes, N_VNew_Serial);
BEAMID_NEEDED(cvodes, SUNContext_Create);
BEAMID_NEEDED(cvodes, SUNContext_Free);
BEAMID_NEEDED(cvodes, SUNNonlinSolFree);
BEAMID_NEEDED(cvodes, SUNNonlinSol_FixedPoint);
BEAMID_NEEDED(cvodes, SUNNonlinSol_FixedPointSens);
#if SUNDIALS_VERSION_MAJOR < 7
BEAMID_NEEDED(cvodes, CVodeSetErrFile);
#else
BEAMID_NEEDED(cvodes, SUNContext_ClearErrHandlers);
#ifdef OPEN_MPI  // what SUN_COMM_NULL stands for
BEAMID_NEEDED_VARIABLE(cvodes, ompi_mpi_comm_null);
#endif
#endif

void require(int flag, const char* call) {
  if (flag >= 0) return;
  const std::unique_ptr<char, decltype(&std::free)> name(CVodeGetReturnFlagName(flag), std::free);
  throw std::runtime_error(std::string(call) + " failed: " + name.get());
}

Eigen::Map<VectorXd> view(N_Vector vector) {
  return {N_VGetArrayPointer(vector), N_VGetLength(vector)};
}

// Failures are thrown, not printed. SUNDIALS 6 is silenced by integrator, 7 by context; of what differs
// between them (fem/response/sundials.hpp) these are the two calls that this scheme needs.
SUNContext silent_context() {
  SUNContext context = nullptr;
#if SUNDIALS_VERSION_MAJOR < 7
  require(SUNContext_Create(nullptr, &context), "SUNContext_Create");
#else
  require(SUNContext_Create(SUN_COMM_NULL, &context), "SUNContext_Create");
  require(SUNContext_ClearErrHandlers(context), "SUNContext_ClearErrHandlers");
#endif
  return context;
}

void silence([[maybe_unused]] void* integrator) {
#if SUNDIALS_VERSION_MAJOR < 7
  require(CVodeSetErrFile(integrator, nullptr), "CVodeSetErrFile");
#endif
}

// What the right-hand sides need to know.
struct Motion {
  const ContinuousModel* model = nullptr;
  VectorXd path, input, state, rate;
  double dt = 1.0;

  void take(double t, N_Vector z) {
    state = view(z);
    input = StepInput(path, model->input_size()).at(t / dt);
  }
  MatrixXd jacobian;
};

int right_hand_side(sunrealtype t, N_Vector z, N_Vector z_rate, void* data) {
  auto& motion = *static_cast<Motion*>(data);
  motion.take(t, z);
  motion.model->rate(motion.state, motion.input, motion.rate);
  view(z_rate) = motion.rate;
  return 0;
}

int sensitivities(int count, sunrealtype t, N_Vector z, N_Vector, N_Vector* s, N_Vector* s_rate, void* data,
                  N_Vector, N_Vector) {
  auto& motion = *static_cast<Motion*>(data);
  motion.take(t, z);
  motion.model->rate_jacobian(motion.state, motion.input, motion.jacobian);
  for (int i = 0; i < count; ++i) view(s_rate[i]) = motion.jacobian * view(s[i]);
  return 0;
}

// CVODES' memory for states of one size. Every resource is freed by its own deleter.
class Integrator {
 public:
  Integrator(Index n, double tolerance, Motion& motion) : n_(static_cast<int>(n)) {
    const SUNContext context = silent_context();
    context_.reset(context);
    state_.reset(N_VNew_Serial(n_, context));
    sensitivity_.reset(N_VCloneVectorArray(n_, state_.get()));
    memory_.reset(CVodeCreate(CV_ADAMS, context));
    view(state_.get()).setZero();
    silence(memory_.get());
    require(CVodeInit(memory_.get(), right_hand_side, 0.0, state_.get()), "CVodeInit");
    require(CVodeSStolerances(memory_.get(), tolerance, tolerance), "CVodeSStolerances");
    require(CVodeSetUserData(memory_.get(), &motion), "CVodeSetUserData");
    solver_.reset(SUNNonlinSol_FixedPoint(state_.get(), 0, context));
    require(CVodeSetNonlinearSolver(memory_.get(), solver_.get()), "CVodeSetNonlinearSolver");
    require(CVodeSensInit(memory_.get(), n_, CV_STAGGERED, sensitivities, sensitivity_.get()),
            "CVodeSensInit");
    require(CVodeSensEEtolerances(memory_.get()), "CVodeSensEEtolerances");
    require(CVodeSetSensErrCon(memory_.get(), SUNTRUE), "CVodeSetSensErrCon");
    sensitivity_solver_.reset(SUNNonlinSol_FixedPointSens(n_, state_.get(), 0, context));
    require(CVodeSetNonlinearSolverSensStg(memory_.get(), sensitivity_solver_.get()),
            "CVodeSetNonlinearSolverSensStg");
  }
  ~Integrator() { N_VDestroyVectorArray(sensitivity_.release(), n_); }

  void advance(const VectorXd& from, double dt, VectorXd& next, MatrixXd* tangent) {
    view(state_.get()) = from;
    require(CVodeReInit(memory_.get(), 0.0, state_.get()), "CVodeReInit");
    require(CVodeSetStopTime(memory_.get(), dt), "CVodeSetStopTime");
    if (tangent) {
      for (int i = 0; i < n_; ++i) view(sensitivity_.get()[i]) = VectorXd::Unit(n_, i);
      require(CVodeSensReInit(memory_.get(), CV_STAGGERED, sensitivity_.get()), "CVodeSensReInit");
    } else {
      require(CVodeSensToggleOff(memory_.get()), "CVodeSensToggleOff");
    }
    sunrealtype reached = 0.0;
    require(CVode(memory_.get(), dt, state_.get(), &reached, CV_NORMAL), "CVode");
    next = view(state_.get());
    if (!tangent) return;
    require(CVodeGetSens(memory_.get(), &reached, sensitivity_.get()), "CVodeGetSens");
    tangent->resize(n_, n_);
    for (int i = 0; i < n_; ++i) tangent->col(i) = view(sensitivity_.get()[i]);
  }

 private:
  struct Free {
    void operator()(SUNContext context) const { SUNContext_Free(&context); }
    void operator()(N_Vector vector) const { N_VDestroy(vector); }
    void operator()(void* memory) const { CVodeFree(&memory); }
    void operator()(SUNNonlinearSolver solver) const { SUNNonlinSolFree(solver); }
    void operator()(N_Vector*) const {}  // needs the count: freed by ~Integrator
  };
  int n_;
  std::unique_ptr<std::remove_pointer_t<SUNContext>, Free> context_;
  std::unique_ptr<std::remove_pointer_t<N_Vector>, Free> state_;
  std::unique_ptr<N_Vector, Free> sensitivity_;
  std::unique_ptr<void, Free> memory_;
  std::unique_ptr<std::remove_pointer_t<SUNNonlinearSolver>, Free> solver_, sensitivity_solver_;
};

class Cvode final : public Scheme {
 public:
  explicit Cvode(double tolerance) : tolerance_(tolerance) {}

  void step(const ContinuousModel& model, const VectorXd& state, const VectorXd& input, double dt,
            VectorXd& next, MatrixXd* tangent) override {
    if (!integrator_) integrator_ = std::make_unique<Integrator>(state.size(), tolerance_, motion_);
    motion_.model = &model;
    motion_.path = input;
    motion_.dt = dt;
    integrator_->advance(state, dt, next, tangent);
  }

  Amplification amplification(std::complex<double> z) const override { return {std::exp(z), std::exp(z)}; }

 private:
  double tolerance_;
  Motion motion_;
  std::unique_ptr<Integrator> integrator_;
};

const bool cvode_registered = scheme_registry().add(
    {"cvode",
     "adaptive (SUNDIALS CVODES), tangent by forward sensitivities; for nonlinear motion",
     "[hindmarsh2005]",
     {{"tolerance", 1e-12, "", "relative and absolute error allowed per step"}},
     {},
     [](const Options& options) { return std::make_unique<Cvode>(options.number("tolerance")); }});

}  // namespace
}  // namespace beamid::filters
