#include "filters/schemes/gauss_step.hpp"

#include "filters/step_input.hpp"

#include <cmath>
#include <stdexcept>

namespace beamid::filters {

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

}  // namespace beamid::filters
