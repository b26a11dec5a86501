// Implicit midpoint rule: z+ = z + dt f((z + z+)/2), g(z) = (1 + z/2) / (1 - z/2).
//
// Second order; on linear motion it is the trapezoidal rule, and keeps the energy of an undamped oscillator.
#include "filters/scheme.hpp"
#include "filters/schemes/implicit_step.hpp"

namespace beamid::filters {
namespace {

class ImplicitMidpoint final : public Scheme {
 public:
  void step(const ContinuousModel& model, const Eigen::VectorXd& state, const Eigen::VectorXd& input,
            double dt, Eigen::VectorXd& next, Eigen::MatrixXd* tangent) override {
    solve_(model, state, input, dt, next, tangent);
  }

  Amplification amplification(std::complex<double> z) const override {
    const std::complex<double> below = 1.0 - 0.5 * z;
    return {(1.0 + 0.5 * z) / below, 1.0 / (below * below)};
  }

 private:
  ImplicitStep solve_{0.5};
};

const bool implicit_midpoint_registered =
    scheme_registry().add({"implicit_midpoint",
                           "implicit, second order, keeps energy",
                           "[hairer1996, ch. IV.3]",
                           {},
                           {},
                           [](const Options&) { return std::make_unique<ImplicitMidpoint>(); }});

}  // namespace
}  // namespace beamid::filters
