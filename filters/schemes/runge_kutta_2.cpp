// Explicit midpoint rule: z+ = z + dt f(z + dt/2 f(z)), g(z) = 1 + z + z^2/2.
#include "filters/scheme.hpp"
#include "filters/step_input.hpp"

namespace beamid::filters {
namespace {

class RungeKutta2 final : public Scheme {
 public:
  void step(const ContinuousModel& model, const Eigen::VectorXd& state, const Eigen::VectorXd& input,
            double dt, Eigen::VectorXd& next, Eigen::MatrixXd* tangent) override {
    const StepInput path(input, model.input_size());
    const Eigen::VectorXd first = path.at(0.0), second = path.at(0.5);
    model.rate(state, first, rate_);
    midpoint_ = state + 0.5 * dt * rate_;
    model.rate(midpoint_, second, rate_);
    next = state + dt * rate_;
    if (!tangent) return;
    model.rate_jacobian(state, first, start_);
    model.rate_jacobian(midpoint_, second, middle_);
    *tangent = dt * middle_ + 0.5 * dt * dt * middle_ * start_;
    tangent->diagonal().array() += 1.0;
  }

  Amplification amplification(std::complex<double> z) const override {
    return {1.0 + z + 0.5 * z * z, 1.0 + z};
  }

 private:
  Eigen::VectorXd rate_, midpoint_;
  Eigen::MatrixXd start_, middle_;
};

const bool runge_kutta_2_registered =
    scheme_registry().add({"runge_kutta_2",
                           "explicit, second order (midpoint)",
                           "[hairer1993, ch. II.1]",
                           {},
                           {},
                           [](const Options&) { return std::make_unique<RungeKutta2>(); }});

}  // namespace
}  // namespace beamid::filters
