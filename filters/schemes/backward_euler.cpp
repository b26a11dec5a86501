// Backward Euler: z+ = z + dt f(z+), g(z) = 1 / (1 - z). First order; finds too little damping.
#include "filters/scheme.hpp"
#include "filters/schemes/implicit_step.hpp"

namespace beamid::filters {
namespace {

class BackwardEuler final : public Scheme {
 public:
  void step(const ContinuousModel& model, const Eigen::VectorXd& state, const Eigen::VectorXd& input,
            double dt, Eigen::VectorXd& next, Eigen::MatrixXd* tangent) override {
    solve_(model, state, input, dt, next, tangent);
  }

  Amplification amplification(std::complex<double> z) const override {
    const std::complex<double> value = 1.0 / (1.0 - z);
    return {value, value * value};
  }

 private:
  ImplicitStep solve_{1.0};
};

const bool backward_euler_registered = scheme_registry().add(
    {"backward_euler", "implicit, first order", "[hairer1996, ch. IV.3]", {}, {}, [](const Options&) {
       return std::make_unique<BackwardEuler>();
     }});

}  // namespace
}  // namespace beamid::filters
