// The classical Runge-Kutta method, g(z) = 1 + z + z^2/2 + z^3/6 + z^4/24.
#include "filters/scheme.hpp"
#include "filters/step_input.hpp"

namespace beamid::filters {
namespace {

class RungeKutta4 final : public Scheme {
 public:
  void step(const ContinuousModel& model, const Eigen::VectorXd& state, const Eigen::VectorXd& input,
            double dt, Eigen::VectorXd& next, Eigen::MatrixXd* tangent) override {
    // k_i = f(z + a_i dt k_i-1), a = 0, 1/2, 1/2, 1;  z+ = z + dt sum b_i k_i, b = 1/6, 1/3, 1/3, 1/6.
    constexpr double node[4] = {0.0, 0.5, 0.5, 1.0};
    constexpr double weight[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    const Eigen::Index n = state.size();
    const StepInput path(input, model.input_size());
    rate_.setZero(n);
    next = state;
    if (tangent) {
      slope_.setZero(n, n);
      tangent->setIdentity(n, n);
    }
    for (int i = 0; i < 4; ++i) {
      point_ = state + node[i] * dt * rate_;
      input_ = path.at(node[i]);
      model.rate(point_, input_, rate_);
      next += weight[i] * dt * rate_;
      if (!tangent) continue;
      model.rate_jacobian(point_, input_, jacobian_);  // dk_i/dz = J (I + a_i dt dk_i-1/dz)
      slope_ = jacobian_ + node[i] * dt * (jacobian_ * slope_).eval();
      *tangent += weight[i] * dt * slope_;
    }
  }

  Amplification amplification(std::complex<double> z) const override {
    const std::complex<double> derivative = 1.0 + z * (1.0 + z * (0.5 + z / 6.0));
    return {derivative + z * z * z * z / 24.0, derivative};
  }

 private:
  Eigen::VectorXd rate_, point_, input_;
  Eigen::MatrixXd jacobian_, slope_;
};

const bool runge_kutta_4_registered =
    scheme_registry().add({"runge_kutta_4",
                           "explicit, fourth order (classical)",
                           "[hairer1993, ch. II.1]",
                           {},
                           {},
                           [](const Options&) { return std::make_unique<RungeKutta4>(); }});

}  // namespace
}  // namespace beamid::filters
