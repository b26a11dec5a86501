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
#include "filters/scheme.hpp"
#include "filters/schemes/gauss_step.hpp"
#include "filters/step_input.hpp"

#include <Eigen/LU>

namespace beamid::filters {
namespace {

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
