// The classical Runge-Kutta step with its tangent by central differences: 2n further steps in place of the
// model's Jacobian. For models that have none worth trusting, and to see what exact tangents are worth.
#include "filters/central_differences.hpp"
#include "filters/scheme.hpp"

namespace beamid::filters {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

class RungeKutta4Differences final : public Scheme {
 public:
  void step(const ContinuousModel& model, const VectorXd& state, const VectorXd& input, double dt,
            VectorXd& next, MatrixXd* tangent) override {
    step_->step(model, state, input, dt, next, nullptr);
    if (!tangent) return;
    const auto move = [&](const VectorXd& z, VectorXd& value) {
      step_->step(model, z, input, dt, value, nullptr);
    };
    central_differences(move, state, state.size(), *tangent);
  }

  Amplification amplification(std::complex<double> z) const override { return step_->amplification(z); }

 private:
  std::unique_ptr<Scheme> step_ = scheme_registry().make("runge_kutta_4", {});
};

const bool runge_kutta_4_differences_registered =
    scheme_registry().add({"runge_kutta_4_differences",
                           "explicit, fourth order (classical), the tangent by central differences",
                           "[hairer1993, ch. II.1]",
                           {},
                           {},
                           [](const Options&) { return std::make_unique<RungeKutta4Differences>(); }});

}  // namespace
}  // namespace beamid::filters
