// Duffing's spring, r = k d + k3 d^3: it hardens, or with k3 < 0 softens, as the square of the amplitude
// [kovacic2011].
#include "experiments/models/springs/spring_law.hpp"

namespace beamid::experiments {
namespace {

class DuffingSpring final : public SpringLaw {
 public:
  explicit DuffingSpring(double cubic) : cubic_(cubic) {}

  std::vector<SpringParameter> parameters() const override {
    return {{{"cubic_stiffness", "N/m3", "n_per_m3"}, cubic_}};
  }
  // p = [k, k3]
  void evaluate(double d, double, double, const SpringVector& p, SpringForce& force) const override {
    const double cube = d * d * d;
    force.value = p[0] * d + p[1] * cube;
    force.by_drift = p[0] + 3.0 * p[1] * d * d;
    force.by_parameter << d, cube;
  }

 private:
  double cubic_;
};

const bool duffing_spring_registered = spring_law_registry().add(
    {"duffing",
     "k d + k3 d^3, elastic",
     "[kovacic2011]",
     {{"cubic_stiffness_n_per_m3", 0.0, "N/m3", "k3, of either sign"}},
     {},
     [](const filters::Options& options) {
       return std::make_unique<DuffingSpring>(options.number("cubic_stiffness_n_per_m3"));
     }});

}  // namespace
}  // namespace beamid::experiments
