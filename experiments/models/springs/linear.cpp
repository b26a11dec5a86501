// The linear spring, r = k d.
#include "experiments/models/springs/spring_law.hpp"

namespace beamid::experiments {
namespace {

class LinearSpring final : public SpringLaw {
 public:
  void evaluate(double drift, double, double, const SpringVector& p, SpringForce& force) const override {
    force.value = p[0] * drift;
    force.by_drift = p[0];
    force.by_parameter[0] = drift;
  }
};

const bool linear_spring_registered = spring_law_registry().add(
    {"linear", "k d, as without a law", "[rayleigh1877]", {}, {}, [](const filters::Options&) {
       return std::make_unique<LinearSpring>();
     }});

}  // namespace
}  // namespace beamid::experiments
