// The (2,2) Pade step: A-stable, of fourth order, and it keeps the energy of an undamped oscillator.
//
//     R(z) = (12 + 6z + z^2) / (12 - 6z + z^2)          e^z - R(z) = z^5/720 + ...
//
// For linear motion x' = A x + B u, Z = A dt, it is taken as the increment d of
//
//     (12 - 6Z + Z^2) d = 12 dt (A x + B mean) - Z dt B slope,   x+ = x + d
//
// with mean and slope of the input over the step (StepInput), which is what R does to the matrix augmented by
// the chain of integrators that makes the input. Its tangent is that of this equation: along Z' = dt
// dA/dtheta_j
//
//     (12 - 6Z + Z^2) d' = 12 dt (A' x + B' mean) - Z' dt B slope - Z dt B' slope
//                          + 6 Z' d - Z' (Z d) - Z (Z' d).
//
// Any other motion takes the Gauss method of two stages, whose stability function is the same R.
#include <cmath>
#include <stdexcept>

#include <Eigen/LU>

#include "filters/continuous_model.hpp"
#include "filters/scheme.hpp"
#include "filters/step_input.hpp"

namespace beamid::filters {
namespace {

// The Gauss collocation method of two stages.

/// Newton solution of  k_i = f(z + dt sum_j a_ij k_j),  z+ = z + dt (k_1 + k_2)/2,
///
///     a = [ 1/4            1/4 - sqrt3/6 ]
///         [ 1/4 + sqrt3/6  1/4           ]
///
/// with the line of the input's mean and slope (StepInput) at the stages, and its tangent I + dt (k_1' +
/// k_2')/2, from (I - dt [a_ij J_i]) k' = [J_1; J_2] [hairer1996, ch. IV.5]. Fourth order. One object per
/// thread: it keeps work space.
class GaussStep {
 public:
  /// @throws std::runtime_error when Newton's method does not converge.
  void operator()(const ContinuousModel& model, const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                  double dt, Eigen::VectorXd& next, Eigen::MatrixXd* tangent);

 private:
  Eigen::VectorXd slopes_, residual_, change_, point_, rate_;
  Eigen::MatrixXd jacobians_, jacobian_, matrix_;
  Eigen::PartialPivLU<Eigen::MatrixXd> factor_;
};

void GaussStep::operator()(const ContinuousModel& model, const Eigen::VectorXd& state,
                           const Eigen::VectorXd& input, double dt, Eigen::VectorXd& next,
                           Eigen::MatrixXd* tangent) {
  constexpr int most_iterations = 50;
  const double offset = std::sqrt(3.0) / 6.0;
  const double a[2][2] = {{0.25, 0.25 - offset}, {0.25 + offset, 0.25}};
  const Eigen::Index n = state.size();
  const StepInput path(input, model.input_size());
  const Eigen::VectorXd mean = path.mean(), turn = offset * path.slope();
  const Eigen::VectorXd inputs[2] = {mean - turn, mean + turn};
  model.rate(state, mean, rate_);
  slopes_.resize(2 * n);
  slopes_ << rate_, rate_;
  residual_.resize(2 * n);
  jacobians_.resize(2 * n, n);
  next = state;
  for (int iteration = 0;; ++iteration) {
    matrix_.setIdentity(2 * n, 2 * n);
    for (int i = 0; i < 2; ++i) {
      point_ = state + dt * (a[i][0] * slopes_.head(n) + a[i][1] * slopes_.tail(n));
      model.rate(point_, inputs[i], rate_);
      model.rate_jacobian(point_, inputs[i], jacobian_);
      residual_.segment(i * n, n) = rate_ - slopes_.segment(i * n, n);
      jacobians_.middleRows(i * n, n) = jacobian_;
      for (int j = 0; j < 2; ++j) matrix_.block(i * n, j * n, n, n) -= dt * a[i][j] * jacobian_;
    }
    factor_.compute(matrix_);
    change_ = factor_.solve(residual_);
    slopes_ += change_;
    next = state + 0.5 * dt * (slopes_.head(n) + slopes_.tail(n));
    const auto moved = 0.5 * dt * (change_.head(n).array().abs() + change_.tail(n).array().abs());
    if ((moved <= 1e-15 * next.array().abs() + 1e-300).all()) break;
    // Rounding may keep the change from vanishing; a step that no longer shrinks below 1e-12 is at rounding.
    if (iteration >= 4 && moved.matrix().norm() <= 1e-12 * next.norm()) break;
    if (iteration == most_iterations || !change_.allFinite())
      throw std::runtime_error(
          "the implicit step does not converge: the interval is too long for this motion");
  }
  if (!tangent) return;
  const Eigen::MatrixXd slope = factor_.solve(jacobians_);
  *tangent = 0.5 * dt * (slope.topRows(n) + slope.bottomRows(n));
  tangent->diagonal().array() += 1.0;
}

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

class Pade final : public Scheme {
 public:
  void step(const ContinuousModel& model, const VectorXd& state, const VectorXd& input, double dt,
            VectorXd& next, MatrixXd* tangent) override {
    if (const auto* linear = dynamic_cast<const LinearMotion*>(&model))
      step_linear(*linear, state, input, dt, next, tangent);
    else
      gauss_(model, state, input, dt, next, tangent);
  }

  Amplification amplification(std::complex<double> z) const override {
    const std::complex<double> square = z * z, below = 12.0 - 6.0 * z + square;
    return {(12.0 + 6.0 * z + square) / below, 12.0 * (12.0 - square) / (below * below)};
  }

 private:
  void step_linear(const LinearMotion& model, const VectorXd& state, const VectorXd& input, double dt,
                   VectorXd& next, MatrixXd* tangent) {
    const Index l = model.motion_size(), q = model.parameter_size(), m = model.input_size();
    const auto x = state.head(l);
    model.motion_matrix(state, z_);
    z_ *= dt;
    below_.noalias() = z_ * z_;
    below_ -= 6.0 * z_;
    below_.diagonal().array() += 12.0;
    factor_.compute(below_);

    rate_.noalias() = z_ * x;
    if (m > 0) {
      const StepInput path(input, m);
      mean_ = path.mean();
      slope_of_input_ = path.slope();
      model.input_matrix(state, b_);
      rate_.noalias() += dt * (b_ * mean_);
      pushed_.noalias() = dt * (b_ * slope_of_input_);
    }
    change_ = 12.0 * rate_;
    if (m > 0) change_.noalias() -= z_ * pushed_;
    change_ = factor_.solve(change_).eval();
    next = state;
    next.head(l) += change_;
    if (!tangent) return;

    moved_.noalias() = z_ * change_;
    if (m > 0) moved_ += pushed_;
    right_.resize(l, l + q);
    right_.leftCols(l) = 12.0 * z_;
    for (Index j = 0; j < q; ++j) {
      model.motion_matrix_derivative(state, j, slope_);
      turned_.noalias() = dt * (slope_ * change_);
      auto column = right_.col(l + j);
      column.noalias() = dt * (slope_ * (12.0 * x - moved_));
      column += 6.0 * turned_;
      column.noalias() -= z_ * turned_;
      if (m == 0) continue;
      model.input_matrix_derivative(state, j, b_);
      column.noalias() += (12.0 * dt) * (b_ * mean_);
      column.noalias() -= z_ * (dt * (b_ * slope_of_input_));
    }
    tangent->setIdentity(state.size(), state.size());
    tangent->topRows(l).leftCols(l + q) += factor_.solve(right_);
  }

  GaussStep gauss_;
  Eigen::PartialPivLU<MatrixXd> factor_;
  VectorXd rate_, change_, moved_, turned_, mean_, slope_of_input_, pushed_;
  MatrixXd z_, below_, right_, slope_, b_;
};

const bool pade_registered = scheme_registry().add(
    {"pade",
     "implicit, fourth order, keeps energy: (2,2) Pade step of linear motion, two-stage Gauss method of any",
     "[hairer1996, ch. IV.3]",
     {},
     {},
     [](const Options&) { return std::make_unique<Pade>(); }});

}  // namespace

}  // namespace beamid::filters
