// The hyperbola of soils, r = k d / (1 + |d| / d_r): half the stiffness is gone at the reference drift d_r
// [hardin1972]. Elastic: it unloads as it was loaded, `beamid backbone`'s law without Masing's loop. A loop
// under any motion needs every reversal remembered, which no state of fixed size does; what dissipates in
// cycles is `bouc_wen`.
#include <cmath>
#include <stdexcept>
#include <string>

#include "experiments/models/springs/spring_law.hpp"

namespace beamid::experiments {
namespace {

template <class Error>
void require_reference_drift(double drift) {
  if (!(drift > 0.0))
    throw Error("reference_drift is " + std::to_string(drift) + " m; expected a number above 0");
}

class HyperbolicSpring final : public SpringLaw {
 public:
  explicit HyperbolicSpring(double reference) : reference_(reference) {
    require_reference_drift<std::invalid_argument>(reference);
  }

  std::vector<SpringParameter> parameters() const override {
    return {{{"reference_drift", "m", "m"}, reference_}};
  }
  // p = [k, d_r]
  void evaluate(double d, double, double, const SpringVector& p, SpringForce& force) const override {
    require_reference_drift<std::runtime_error>(p[1]);
    const double ratio = std::abs(d) / p[1], share = 1.0 / (1.0 + ratio);
    force.value = p[0] * d * share;
    force.by_drift = p[0] * share * share;
    force.by_parameter << d * share, p[0] * d * ratio * share * share / p[1];
  }

 private:
  double reference_;
};

const bool hyperbolic_spring_registered = spring_law_registry().add(
    {"hyperbolic",
     "k d / (1 + |d| / d_r), elastic: soil that softens",
     "[hardin1972]",
     {{"reference_drift_m", 0.01, "m", "d_r, at which half the stiffness remains"}},
     {},
     [](const filters::Options& options) {
       return std::make_unique<HyperbolicSpring>(options.number("reference_drift_m"));
     }});

}  // namespace
}  // namespace beamid::experiments
