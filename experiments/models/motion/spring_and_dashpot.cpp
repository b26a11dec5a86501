#include "experiments/models/motion/spring_and_dashpot.hpp"

#include <utility>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

class SpringAndDashpot final : public OscillatorLaw {
 public:
  explicit SpringAndDashpot(std::shared_ptr<const SpringLaw> spring) : spring_(std::move(spring)) {}

  bool slips() const override { return spring_->slips(); }
  // p = [K, C, ...], of the spring without C; behind the law's own stands the mass
  void evaluate(double x, double v, double s, const VectorXd& p, OscillatorForce& force) const override {
    const Index k = force.by_parameter.size();
    SpringVector own(k - 1);
    own << p[0], p.segment(2, k - 2);
    SpringForce spring(k - 1);
    spring_->evaluate(x, v, s, own, spring);
    force.value = spring.value + p[1] * v;
    force.by_displacement = spring.by_drift;
    force.by_velocity = p[1];
    force.by_slip = spring.by_slip;
    force.by_parameter << spring.by_parameter[0], v, spring.by_parameter.tail(k - 2);
    force.slip_rate = spring.slip_rate;
    force.slip_by_displacement = spring.slip_by_drift;
    force.slip_by_velocity = spring.slip_by_rate;
    force.slip_by_slip = spring.slip_by_slip;
    force.slip_by_parameter << spring.slip_by_parameter[0], 0.0, spring.slip_by_parameter.tail(k - 2);
  }

 private:
  std::shared_ptr<const SpringLaw> spring_;
};

}  // namespace

std::shared_ptr<const OscillatorLaw> spring_and_dashpot(std::shared_ptr<const SpringLaw> spring) {
  return std::make_shared<SpringAndDashpot>(std::move(spring));
}

}  // namespace beamid::experiments
