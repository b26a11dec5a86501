#include "filters/schemes/implicit_step.hpp"

#include <Eigen/LU>
#include <stdexcept>

#include "filters/step_input.hpp"

namespace beamid::filters {

void ImplicitStep::operator()(const ContinuousModel& model, const Eigen::VectorXd& state,
                              const Eigen::VectorXd& input, double dt, Eigen::VectorXd& next,
                              Eigen::MatrixXd* tangent) {
  constexpr int most_iterations = 50;
  const Eigen::Index n = state.size();
  const Eigen::VectorXd there = StepInput(input, model.input_size()).at(theta_);
  next = state;
  for (int iteration = 0;; ++iteration) {
    point_ = (1.0 - theta_) * state + theta_ * next;
    model.rate(point_, there, rate_);
    model.rate_jacobian(point_, there, jacobian_);
    matrix_ = Eigen::MatrixXd::Identity(n, n) - theta_ * dt * jacobian_;
    change_ = matrix_.partialPivLu().solve(state + dt * rate_ - next);
    next += change_;
    if ((change_.array().abs() <= 1e-14 * next.array().abs() + 1e-300).all()) break;
    // Rounding may keep the change from vanishing; a step that no longer shrinks below 1e-12 is at rounding.
    if (iteration >= 4 && change_.norm() <= 1e-12 * next.norm()) break;
    if (iteration == most_iterations || !change_.allFinite())
      throw std::runtime_error(
          "the implicit step does not converge: the interval is too long for this motion");
  }
  if (tangent)
    *tangent =
        matrix_.partialPivLu().solve(Eigen::MatrixXd::Identity(n, n) + (1.0 - theta_) * dt * jacobian_);
}

}  // namespace beamid::filters
