// The Bouc-Wen oscillator: part of the spring slips and remembers [wen1976],
//
//     M x'' + C x' + alpha K x + (1 - alpha) K h = e f
//     h' = x' - |h/l|^(n-1) (beta |x'| h + gamma x' |h|)
//
// The state carries the slip s = x - h in place of h: small motion then is that of the spring K, and s at
// rest. beta and gamma are in 1/m whatever n is; l, of no effect at n = 1, is the displacement at which an
// exponent above one yields as n = 1 does. Under monotonic motion h tends to 1 / (beta + gamma) at n = 1.
#include <cmath>
#include <stdexcept>

#include "experiments/models/motion/oscillator_motion.hpp"

namespace beamid::experiments {
namespace {

class BoucWen final : public OscillatorLaw {
 public:
  BoucWen(double exponent, double length) : n_(exponent), length_(length) {}

  bool slips() const override { return true; }
  // p = [K, C, alpha, beta, gamma]
  void evaluate(double x, double v, double s, const Eigen::VectorXd& p, OscillatorForce& f) const override {
    const double h = x - s, size = std::abs(h), speed = std::abs(v);
    const double power = n_ == 1.0 ? 1.0 : std::pow(size / length_, n_ - 1.0);
    f.value = p[0] * x - (1.0 - p[2]) * p[0] * s + p[1] * v;
    f.by_displacement = p[0];
    f.by_velocity = p[1];
    f.by_slip = -(1.0 - p[2]) * p[0];
    f.by_parameter << x - (1.0 - p[2]) * s, v, p[0] * s, 0.0, 0.0;
    f.slip_rate = power * (p[3] * speed * h + p[4] * v * size);
    f.slip_by_displacement = n_ * power * (p[3] * speed + p[4] * v * std::copysign(1.0, h));
    f.slip_by_slip = -f.slip_by_displacement;
    f.slip_by_velocity = power * (p[3] * std::copysign(1.0, v) * h + p[4] * size);
    f.slip_by_parameter << 0.0, 0.0, 0.0, power * speed * h, power * v * size;
  }

 private:
  double n_, length_;
};

std::unique_ptr<JointModel> make_bouc_wen(const ModelSetting& setting, const filters::Options& options) {
  constexpr double stiffness_doubt = 0.3, half = 0.5;
  const double exponent = options.number("exponent"), length = options.number("reference_length_m");
  if (!(exponent >= 1.0 && length > 0.0))
    throw std::invalid_argument("exponent is " + std::to_string(exponent) + " and reference_length_m " +
                                std::to_string(length) + "; expected at least 1, and more than 0");
  const ExpectedOscillator beam = expected_oscillator("bouc_wen", setting);
  const double rate = half / beam.amplitude;  // yields at the usual amplitude
  return make_oscillator(
      "bouc_wen", setting, std::make_shared<BoucWen>(exponent, length),
      {{"stiffness", beam.stiffness, stiffness_doubt * beam.stiffness, true},
       {"damping", beam.damping, beam.damping, true},
       {"post_yield_ratio", half, 0.3, false, true, options.number("post_yield_ratio")},
       {"hysteresis_beta", rate, rate, false, true, options.number("hysteresis_beta_per_m")},
       {"hysteresis_gamma", rate, rate, false, true, options.number("hysteresis_gamma_per_m")}},
      options.flag("sensor_bias"));
}

const bool bouc_wen_registered = model_registry().add(
    {"bouc_wen",
     "one degree of freedom with hysteresis: K, C, alpha, beta and gamma unknown, the exponent known",
     "[wen1976]",
     {{"sensor_bias", true, "", "estimate the constant offset of every accelerometer too"},
      {"exponent", 1.0, "", "n, at least 1"},
      {"reference_length_m", 1e-3, "m", "l, of no effect at n = 1"},
      {"post_yield_ratio", 0.5, "", "alpha where [[parameters]] do not ask about it"},
      {"hysteresis_beta_per_m", 0.0, "1/m", "beta, likewise"},
      {"hysteresis_gamma_per_m", 0.0, "1/m", "gamma, likewise"}},
     {},
     make_bouc_wen});

}  // namespace
}  // namespace beamid::experiments
