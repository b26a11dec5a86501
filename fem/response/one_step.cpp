#include "fem/response/one_step.hpp"

#include <limits>
#include <sstream>
#include <stdexcept>

#include "fem/response/method.hpp"
#include "fem/response/symmetric_factor.hpp"

namespace beamid::fem {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

PointForces::PointForces(const std::vector<NonlinearForce>& forces) {
  const auto count = static_cast<Index>(forces.size());
  if (count == 0) return;
  directions_.resize(forces.front().direction.rows(), count);
  cubic_.resize(count);
  quadratic_.resize(count);
  for (Index j = 0; j < count; ++j) {
    directions_.col(j) = forces[j].direction;
    cubic_[j] = forces[j].cubic_stiffness;
    quadratic_[j] = forces[j].quadratic_damping;
  }
}

VectorXd PointForces::force(const VectorXd& x, const VectorXd& rate) const {
  return cubic_.cwiseProduct(x).cwiseProduct(x.cwiseAbs2()) +
         quadratic_.cwiseProduct(rate).cwiseProduct(rate.cwiseAbs());
}

void PointForces::subtract(const VectorXd& q, const VectorXd& velocity, VectorXd& force) const {
  if (empty()) return;
  force -= directions_ * this->force(directions_.transpose() * q, directions_.transpose() * velocity);
}

bool PointForces::solve(const VectorXd& x, const VectorXd& rate, double a, double b,
                        const MatrixXd& flexibility, VectorXd& guess) const {
  constexpr double rounding = 8.0 * std::numeric_limits<double>::epsilon();
  for (int iteration = 0; iteration < 50; ++iteration) {
    const VectorXd moved = flexibility * guess, at = x - a * moved, speed = rate - b * moved;
    const VectorXd target = force(at, speed), residual = target - guess;
    MatrixXd slope = (a * stiffness(at) + b * damping(speed)).asDiagonal() * flexibility;
    slope.diagonal().array() += 1.0;
    const VectorXd change = slope.partialPivLu().solve(residual);
    if (!change.allFinite()) return false;
    guess += change;
    if (change.norm() <= rounding * (guess.norm() + target.norm())) return true;
  }
  return false;
}

namespace {

class OneStepIntegrator {
 public:
  OneStepIntegrator(const ResponseProblem& problem, const OneStepScheme& scheme)
      : problem_(problem),
        scheme_(scheme),
        law_(direct_damping(problem, scheme.name)),
        h_(problem.grid.interval),
        now_(1.0 - scheme.force_average),
        displaced_(now_ * scheme.beta * h_ * h_),
        sped_(now_ * scheme.gamma * h_),
        mass_(problem.system.mass),
        dashpots_(problem.system.damping),
        inputs_(problem.system.inputs),
        elastic_(problem.system.stiffness),
        effective_(effective_matrix(), scheme.name + ": the matrix of a time step"),
        points_(problem.system.nonlinear_forces),
        refined_(needs_refinement()) {
    d_ = problem.displacement;
    v_ = problem.velocity;
    find_initial_acceleration();
    if (points_.empty()) return;
    moved_.resize(d_.size(), points_.directions().cols());
    for (Index j = 0; j < moved_.cols(); ++j) {
      right_ = points_.directions().col(j);
      solve();
      moved_.col(j) = right_;
    }
    flexibility_ = points_.directions().transpose() * moved_;
    forces_ = points_.force(points_.directions().transpose() * d_, points_.directions().transpose() * v_);
  }

  // From sample - 1 to sample.
  void advance(Index sample) {
    const double h = h_, beta = scheme_.beta, gamma = scheme_.gamma, past = scheme_.force_average;
    at_ = d_ + (now_ * h) * v_ + (now_ * h * h * (0.5 - beta)) * a_;  // d_f without a_1
    rate_ = v_ + (now_ * h * (1.0 - gamma)) * a_;                     // v_f without a_1
    d_ += h * v_ + (h * h * (0.5 - beta)) * a_;
    v_ += (h * (1.0 - gamma)) * a_;
    set_forces(sample, past);
    resist(at_, rate_, scheme_.mass_average);
    solve();
    if (!points_.empty()) add_point_forces(sample);
    a_.swap(right_);
    d_ += (beta * h * h) * a_;
    v_ += (gamma * h) * a_;
  }

  const VectorXd& displacement() const { return d_; }
  const VectorXd& velocity() const { return v_; }
  const VectorXd& acceleration() const { return a_; }

 private:
  double mass_weight() const { return 1.0 - scheme_.mass_average + sped_ * law_.mass; }
  double stiffness_weight() const { return displaced_ + sped_ * law_.stiffness; }

  SparseMatrix effective_matrix() const {
    SparseMatrix matrix =
        mass_weight() * problem_.system.mass + stiffness_weight() * problem_.system.stiffness.assembled();
    if (problem_.system.damping.nonZeros() > 0) matrix += sped_ * problem_.system.damping;
    return matrix;
  }

  // The assembled K in the matrix of a step has lost digits: a slow motion sees it wrong by about this much.
  bool needs_refinement() const {
    const SparseMatrix stiffness = problem_.system.stiffness.assembled();
    const double largest =
        (stiffness.diagonal().array() / problem_.system.mass.diagonal().array()).maxCoeff();
    return std::numeric_limits<double>::epsilon() * displaced_ * largest > 1e-7;
  }

  // A second solution, for what the first leaves over in terms of the strain factors, wins the digits back.
  void solve() {
    if (!refined_) return effective_.solve_in_place(right_);
    first_ = right_;
    effective_.solve_in_place(first_);
    weighted_ = mass_weight() * first_;
    mass_.subtract(weighted_, right_);
    weighted_ = stiffness_weight() * first_;
    elastic_.subtract(weighted_, right_);
    weighted_ = sped_ * first_;
    dashpots_.subtract(weighted_, right_);
    effective_.solve_in_place(right_);
    right_ += first_;
  }

  void set_forces(Index sample, double past) {
    if (!problem_.has_inputs())
      right_.setZero(d_.size());
    else if (past == 0.0)
      right_.noalias() = inputs_ * problem_.inputs.col(sample);
    else
      right_.noalias() =
          inputs_ * (past * problem_.inputs.col(sample - 1) + now_ * problem_.inputs.col(sample));
  }

  // right -= past M a + C rate + K at
  void resist(const VectorXd& at, const VectorXd& rate, double past) {
    if (law_.mass != 0.0 || past != 0.0) {
      weighted_ = past * a_ + law_.mass * rate;
      mass_.subtract(weighted_, right_);
    }
    dashpots_.subtract(rate, right_);
    if (law_.stiffness == 0.0) {
      elastic_.subtract(at, right_);
    } else {
      strained_ = at + law_.stiffness * rate;
      elastic_.subtract(strained_, right_);
    }
  }

  void find_initial_acceleration() {
    a_ = VectorXd::Zero(d_.size());
    right_.setZero(d_.size());
    if (problem_.has_inputs()) right_.noalias() = inputs_ * problem_.inputs.col(0);
    resist(d_, v_, 0.0);
    points_.subtract(d_, v_, right_);
    a_ = right_;
    SymmetricFactor(problem_.system.mass, scheme_.name + ": the mass matrix").solve_in_place(a_);
  }

  // right is a_1 without the point forces; they take off sum_j moved_j g_j
  void add_point_forces(Index sample) {
    const MatrixXd& c = points_.directions();
    const VectorXd x = c.transpose() * (at_ + displaced_ * right_),
                   rate = c.transpose() * (rate_ + sped_ * right_);
    if (!points_.solve(x, rate, displaced_, sped_, flexibility_, forces_)) {
      std::ostringstream message;
      message << scheme_.name << ": the forces of cubic springs and quadratic dashpots do not converge at "
              << problem_.time(sample) << " s; expected a shorter interval than " << h_ << " s";
      throw std::runtime_error(message.str());
    }
    right_.noalias() -= moved_ * forces_;
  }

  const ResponseProblem& problem_;
  OneStepScheme scheme_;
  ProportionalDamping law_;
  double h_, now_;           // now = 1 - alpha_f
  double displaced_, sped_;  // d_f and v_f per a_1
  DiagonalProduct mass_, dashpots_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> inputs_;
  StrainForce elastic_;
  SymmetricFactor effective_;
  PointForces points_;
  bool refined_;
  MatrixXd moved_, flexibility_;  // A^-1 c, c^T A^-1 c
  VectorXd forces_;               // g
  VectorXd d_, v_, a_, at_, rate_, strained_, weighted_, first_, right_;
};

}  // namespace

Response integrate(const ResponseProblem& problem, const OneStepScheme& scheme) {
  OneStepIntegrator integrator(problem, scheme);
  ResponseRecorder recorder(problem);
  for (Index sample = 0; sample < problem.grid.samples; ++sample) {
    if (sample > 0) integrator.advance(sample);
    if (!integrator.displacement().allFinite() || !integrator.acceleration().allFinite()) {
      std::ostringstream message;
      message << scheme.name << ": the motion has grown beyond all numbers at " << problem.time(sample)
              << " s; expected a stable scheme, a shorter interval, or a motion that has bounds";
      throw std::runtime_error(message.str());
    }
    recorder.record(sample, integrator.displacement(), integrator.velocity(), integrator.acceleration());
  }
  return std::move(recorder.response());
}

}  // namespace beamid::fem
