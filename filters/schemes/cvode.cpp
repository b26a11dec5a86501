// Adaptive integration over each step by SUNDIALS CVODES (Adams), the tangent by forward sensitivities:
// dS/dt = J(z) S, S(0) = I [hindmarsh2005]. For nonlinear motion, and the check of every other scheme.
#include <sundials_functions.hpp>

#include <cstdlib>
#include <memory>
#include <string>

#include "filters/scheme.hpp"
#include "filters/step_input.hpp"

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

void require(int flag, const char* call) {
  if (flag >= 0) return;
  const std::unique_ptr<char, decltype(&std::free)> name(CVodeGetReturnFlagName(flag), std::free);
  throw std::runtime_error(std::string(call) + " failed: " + name.get());
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
    SUNContext context = nullptr;
    require(create_sundials_context(&context), "SUNContext_Create");
    context_.reset(context);
    state_.reset(N_VNew_Serial(n_, context));
    sensitivity_.reset(N_VCloneVectorArray(n_, state_.get()));
    memory_.reset(CVodeCreate(CV_ADAMS, context));
    view(state_.get()).setZero();
    require(silence_cvode(memory_.get(), context), "silence_cvode");
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
