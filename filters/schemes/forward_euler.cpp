// Forward Euler, the scheme of [inverse2009]: z+ = z + dt f(z), g(z) = 1 + z.
//
// The input is that at the start of the step, however it runs on. First order: a free decay seen through it
// comes out K dt too damped (docs/theory/discretisation_bias.md).
#include "filters/scheme.hpp"
#include "filters/step_input.hpp"

namespace beamid::filters {
namespace {

class ForwardEuler final : public Scheme {
 public:
  void step(const ContinuousModel& model, const Eigen::VectorXd& state, const Eigen::VectorXd& input,
            double dt, Eigen::VectorXd& next, Eigen::MatrixXd* tangent) override {
    const Eigen::VectorXd now = StepInput(input, model.input_size()).at(0.0);
    model.rate(state, now, rate_);
    next = state + dt * rate_;
    if (!tangent) return;
    model.rate_jacobian(state, now, *tangent);
    *tangent *= dt;
    tangent->diagonal().array() += 1.0;
  }

  Amplification amplification(std::complex<double> z) const override { return {1.0 + z, 1.0}; }

 private:
  Eigen::VectorXd rate_;
};

const bool forward_euler_registered =
    scheme_registry().add({"forward_euler",
                           "explicit, first order; the scheme of the 2009 paper",
                           "[inverse2009]",
                           {},
                           {},
                           [](const Options&) { return std::make_unique<ForwardEuler>(); }});

}  // namespace
}  // namespace beamid::filters
