// The (2,2) Pade step: A-stable, of fourth order, and it keeps the energy of an undamped oscillator.
//
//     R(z) = (12 + 6z + z^2) / (12 - 6z + z^2)          e^z - R(z) = z^5/720 + ...
//
// For linear motion x' = A x + B u with held u, Z = A dt, it is taken as the increment d of
//
//     (12 - 6Z + Z^2) d = 12 dt (A x + B u),   x+ = x + d
//
// which is what R does to [A B; 0 0], the augmented matrix. Its tangent is that of this equation: along
// Z' = dt dA/dtheta_j
//
//     (12 - 6Z + Z^2) d' = 12 dt (A' x + B' u) + 6 Z' d - Z' (Z d) - Z (Z' d).
//
// Any other motion takes the Gauss method of two stages, whose stability function is the same R.
#include "filters/scheme.hpp"
#include "filters/schemes/gauss_step.hpp"

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
      model.input_matrix(state, b_);
      rate_.noalias() += dt * (b_ * input);
    }
    change_ = factor_.solve(12.0 * rate_);
    next = state;
    next.head(l) += change_;
    if (!tangent) return;

    moved_.noalias() = z_ * change_;
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
      column.noalias() += (12.0 * dt) * (b_ * input);
    }
    tangent->setIdentity(state.size(), state.size());
    tangent->topRows(l).leftCols(l + q) += factor_.solve(right_);
  }

  GaussStep gauss_;
  Eigen::PartialPivLU<MatrixXd> factor_;
  VectorXd rate_, change_, moved_, turned_;
  MatrixXd z_, below_, right_, slope_, b_;
};

const bool registered = scheme_registry().add(
    {"pade",
     "implicit, fourth order, keeps energy: (2,2) Pade step of linear motion, two-stage Gauss method of any",
     "[hairer1996, ch. IV.3]",
     {},
     {},
     [](const Options&) { return std::make_unique<Pade>(); }});

}  // namespace
}  // namespace beamid::filters
