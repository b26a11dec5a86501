#include "fem/response/sundials.hpp"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "fem/response/method.hpp"

namespace beamid::fem {

using Eigen::Index, Eigen::Ref, Eigen::VectorXd;

MotionEquations::MotionEquations(const ResponseProblem& problem, const std::string& method)
    : problem_(problem),
      law_(direct_damping(problem, method)),
      damping_(proportional_damping(problem.damping, problem.system)),
      stiffness_(problem.system.stiffness.assembled()),
      inputs_(problem.system.inputs),
      mass_(problem.system.mass),
      dashpots_(problem.system.damping),
      elastic_(problem.system.stiffness),
      mass_factor_(problem.system.mass, method + ": the mass matrix"),
      points_(problem.system.nonlinear_forces) {
  if (problem.system.damping.nonZeros() > 0) damping_ += problem.system.damping;
  // Every entry that the effective matrix can have, so that its pattern never changes.
  const auto positions = [](SparseMatrix matrix) {
    matrix.coeffs().setZero();
    return matrix;
  };
  pattern_ = positions(problem.system.mass) + positions(stiffness_) + positions(damping_);
  for (const NonlinearForce& force : problem.system.nonlinear_forces)
    pattern_ += positions(force.direction * force.direction.transpose());
  pattern_.makeCompressed();
  point_stiffness_.setZero(points_.empty() ? 0 : points_.directions().cols());
  point_damping_ = point_stiffness_;
}

VectorXd MotionEquations::initial_state() const {
  VectorXd state(2 * size());
  state << problem_.displacement, problem_.velocity;
  return state;
}

void MotionEquations::rate(double t, const Ref<const VectorXd>& y, Ref<VectorXd> y_rate) {
  const Index n = size();
  q_ = y.head(n);
  v_ = y.tail(n);
  force_.setZero(n);
  if (problem_.has_inputs()) {
    const Index last = problem_.inputs.cols() - 1;
    const double place = std::clamp(t / problem_.grid.interval, 0.0, static_cast<double>(last));
    const Index before = std::min(static_cast<Index>(place), std::max<Index>(last - 1, 0)),
                after = std::min(before + 1, last);
    const double part = place - static_cast<double>(before);
    force_.noalias() +=
        inputs_ * ((1.0 - part) * problem_.inputs.col(before) + part * problem_.inputs.col(after));
  }
  if (law_.mass != 0.0) {
    weighted_ = law_.mass * v_;
    mass_.subtract(weighted_, force_);
  }
  dashpots_.subtract(v_, force_);
  points_.subtract(q_, v_, force_);
  weighted_ = q_ + law_.stiffness * v_;
  elastic_.subtract(weighted_, force_);
  mass_factor_.solve_in_place(force_);
  y_rate.head(n) = v_;
  y_rate.tail(n) = force_;
}

const SparseMatrix& MotionEquations::effective_matrix(double gamma, const Ref<const VectorXd>& y) {
  gamma_ = gamma;
  effective_ = pattern_ + problem_.system.mass + gamma * damping_ + (gamma * gamma) * stiffness_;
  if (!points_.empty()) {
    const auto& c = points_.directions();
    point_stiffness_ = points_.stiffness(c.transpose() * y.head(size()));
    point_damping_ = points_.damping(c.transpose() * y.tail(size()));
    for (Index j = 0; j < c.cols(); ++j) {
      const SparseMatrix& direction = problem_.system.nonlinear_forces[j].direction;
      effective_ += (gamma * point_damping_[j] + gamma * gamma * point_stiffness_[j]) *
                    SparseMatrix(direction * direction.transpose());
    }
  }
  effective_.makeCompressed();
  return effective_;
}

const VectorXd& MotionEquations::reduce(const Ref<const VectorXd>& b) {
  right_.setZero(size());
  q_ = b.tail(size());
  mass_.add(q_, right_);
  q_ = gamma_ * b.head(size());
  elastic_.subtract(q_, right_);
  if (!points_.empty())
    right_ -= points_.directions() * point_stiffness_.cwiseProduct(points_.directions().transpose() * q_);
  return right_;
}

// The solver that the integrators see: of the matrix for n unknowns, but given and giving 2n of them.
struct SundialsMotion::Klu {
  MotionEquations* equations;
  Sundials<N_Vector> right, solution;  // (n)
  Sundials<SUNLinearSolver> klu;

  static Klu& of(SUNLinearSolver solver) { return *static_cast<Klu*>(solver->content); }

  static int solve(SUNLinearSolver solver, SUNMatrix matrix, N_Vector x, N_Vector b, sunrealtype tolerance) {
    Klu& self = of(solver);
    const Index n = self.equations->size();
    view(self.right.get()) = self.equations->reduce(view(b));
    const int flag = SUNLinSolSolve(self.klu.get(), matrix, self.solution.get(), self.right.get(), tolerance);
    if (flag != 0) return flag;
    const double gamma = self.equations->gamma();
    view(x).head(n) = view(b).head(n) + gamma * view(self.solution.get());  // x and b may be the same
    view(x).tail(n) = view(self.solution.get());
    return 0;
  }

  static Sundials<SUNLinearSolver> create(MotionEquations& equations, SUNMatrix matrix, SUNContext context) {
    const auto n = static_cast<sunindextype>(equations.size());
    auto content = std::make_unique<Klu>();
    content->equations = &equations;
    content->right.reset(N_VNew_Serial(n, context));
    content->solution.reset(N_VNew_Serial(n, context));
    content->klu.reset(SUNLinSol_KLU(content->right.get(), matrix, context));
    Sundials<SUNLinearSolver> solver(SUNLinSolNewEmpty(context));
    if (!content->right || !content->solution || !content->klu || !solver) throw std::bad_alloc();
    solver->ops->gettype = [](SUNLinearSolver) { return SUNLINEARSOLVER_DIRECT; };
    solver->ops->getid = [](SUNLinearSolver) { return SUNLINEARSOLVER_CUSTOM; };
    solver->ops->initialize = [](SUNLinearSolver self) { return SUNLinSolInitialize(of(self).klu.get()); };
    solver->ops->setup = [](SUNLinearSolver self, SUNMatrix a) {
      return SUNLinSolSetup(of(self).klu.get(), a);
    };
    solver->ops->solve = solve;
    solver->ops->free = [](SUNLinearSolver self) {
      delete static_cast<Klu*>(self->content);
      SUNLinSolFreeEmpty(self);
      return 0;
    };
    solver->content = content.release();
    return solver;
  }
};

SundialsMotion::SundialsMotion(const ResponseProblem& problem, const std::string& method, double absolute)
    : equations(problem, method) {
  const Index n = equations.size();
  const auto unknowns = static_cast<sunindextype>(n);  // of 64 bits on Debian 12, of 32 on Debian 13
  SUNContext created = nullptr;
  if (create_sundials_context(&created) != 0) throw std::bad_alloc();
  context.reset(created);
  for (Sundials<N_Vector>* vector : {&state, &absolute_tolerances, &work}) {
    vector->reset(N_VNew_Serial(2 * unknowns, created));
    if (!*vector) throw std::bad_alloc();
  }
  view(state.get()) = equations.initial_state();
  view(absolute_tolerances.get()).head(n).setConstant(absolute);
  view(absolute_tolerances.get()).tail(n).setConstant(absolute / problem.grid.interval);
  const SparseMatrix& pattern = equations.effective_matrix(0.0, view(state.get()));
  matrix.reset(
      SUNSparseMatrix(unknowns, unknowns, static_cast<sunindextype>(pattern.nonZeros()), CSC_MAT, created));
  if (!matrix) throw std::bad_alloc();
  set_matrix(matrix.get(), 0.0, state.get(), this);
  solver = Klu::create(equations, matrix.get(), created);
}

Response SundialsMotion::follow(const ResponseProblem& problem, const std::function<void(double)>& advance) {
  ResponseRecorder recorder(problem);
  const Index n = equations.size();
  VectorXd y = view(state.get()), y_rate(2 * n);
  equations.rate(0.0, y, y_rate);
  recorder.record(0, y.head(n), y.tail(n), y_rate.tail(n));
  for (Index sample = 1; sample < problem.grid.samples; ++sample) {
    advance(problem.time(sample));
    y = view(state.get());
    recorder.record(sample, y.head(n), y.tail(n), view(work.get()).tail(n));
  }
  return std::move(recorder.response());
}

int SundialsMotion::rate(sunrealtype t, N_Vector y, N_Vector y_rate, void* data) {
  static_cast<SundialsMotion*>(data)->equations.rate(t, view(y), view(y_rate));
  return 0;
}

int SundialsMotion::set_matrix(SUNMatrix matrix, sunrealtype gamma, N_Vector y, void* data) {
  const SparseMatrix& from = static_cast<SundialsMotion*>(data)->equations.effective_matrix(gamma, view(y));
  if (SUNSparseMatrix_NNZ(matrix) != from.nonZeros()) return -1;
  std::copy_n(from.outerIndexPtr(), from.cols() + 1, SUNSparseMatrix_IndexPointers(matrix));
  std::copy_n(from.innerIndexPtr(), from.nonZeros(), SUNSparseMatrix_IndexValues(matrix));
  std::copy_n(from.valuePtr(), from.nonZeros(), SUNSparseMatrix_Data(matrix));
  return 0;
}

void require_success(int flag, const std::string& method, const char* call, double time,
                     char* (*flag_name)(long int)) {
  if (flag >= 0) return;
  const std::unique_ptr<char, decltype(&std::free)> name(flag_name(flag), std::free);
  std::ostringstream message;
  message << method << ": " << call << " failed at " << time << " s: " << name.get();
  throw std::runtime_error(message.str());
}

}  // namespace beamid::fem
