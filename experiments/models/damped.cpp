// One degree of freedom with the damping laws of real beams, and a stiffness that depends on amplitude:
//
//     M x'' + C x' + F_c tanh(x'/v_0) + c_2 x' |x'| + K x + K3 x^3 = e f
//
// Viscous, Coulomb (dry friction of a clamp) and quadratic (air) damping. The sign of the velocity is
// smoothed over v_0, an option: far below the velocities of the record it does not matter. At the amplitude a
// the damping ratio is that of the viscous damping that dissipates as much per cycle [jacobsen1930],
//
//     C + 4 F_c / (pi a omega) + 8 c_2 a omega / (3 pi)
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/models/motion/oscillator_motion.hpp"

namespace beamid::experiments {
namespace {

class Damped final : public OscillatorLaw {
 public:
  explicit Damped(double friction_velocity) : v0_(friction_velocity) {}

  // p = [K, C, K3, F_c, c_2]
  void evaluate(double x, double v, double, const Eigen::VectorXd& p, OscillatorForce& force) const override {
    const double sign = std::tanh(v / v0_), cube = x * x * x, square = v * std::abs(v);
    force.value = p[0] * x + p[1] * v + p[2] * cube + p[3] * sign + p[4] * square;
    force.by_displacement = p[0] + 3.0 * p[2] * x * x;
    force.by_velocity = p[1] + p[3] * (1.0 - sign * sign) / v0_ + 2.0 * p[4] * std::abs(v);
    force.by_parameter << x, v, cube, sign, square;
  }

 private:
  double v0_;  // [m/s]
};

std::unique_ptr<JointModel> make_damped(const ModelSetting& setting, const filters::Options& options) {
  constexpr double stiffness_uncertainty = 0.3, small_ratio = 0.001, uncertainty = 10.0;
  const double v0 = options.number("friction_velocity_m_per_s");
  if (!(v0 > 0.0))
    throw std::invalid_argument("friction_velocity_m_per_s is " + std::to_string(v0) +
                                "; expected more than 0");
  const ExpectedOscillator beam = expected_oscillator("damped", setting);
  // Each law as much as a damping ratio of 0.1 % at the usual amplitude, and ten times as uncertain.
  const double a = beam.amplitude, omega = std::sqrt(beam.stiffness / beam.mass);
  const double viscous = 2.0 * small_ratio * omega * beam.mass;
  const double friction = viscous * std::numbers::pi * a * omega / 4.0;
  const double quadratic = viscous * 3.0 * std::numbers::pi / (8.0 * a * omega);
  const double cubic = 0.01 * beam.stiffness / (a * a);
  return make_oscillator(
      "damped", setting, std::make_shared<Damped>(v0),
      {{"stiffness", beam.stiffness, stiffness_uncertainty * beam.stiffness, true},
       {"damping", beam.damping, beam.damping, true},
       {"cubic_stiffness", cubic, 100.0 * cubic, false, false, options.number("cubic_stiffness_n_per_m3")},
       {"coulomb_friction", friction, uncertainty * friction, false, true,
        options.number("coulomb_friction_n")},
       {"quadratic_damping", quadratic, uncertainty * quadratic, false, true,
        options.number("quadratic_damping_n_s2_per_m2")}},
      options.flag("sensor_bias"));
}

const bool damped_registered = model_registry().add(
    {"damped",
     "one degree of freedom with viscous, Coulomb and quadratic damping, and a cubic spring where requested",
     "[jacobsen1930]",
     {{"sensor_bias", true, "", "estimate the constant offset of every accelerometer too"},
      {"friction_velocity_m_per_s", 1e-3, "m/s", "over which the sign of the velocity is smoothed"},
      {"coulomb_friction_n", 0.0, "N", "where [[parameters]] do not request it"},
      {"quadratic_damping_n_s2_per_m2", 0.0, "N s2/m2", "likewise"},
      {"cubic_stiffness_n_per_m3", 0.0, "N/m3", "likewise"}},
     {},
     make_damped});

}  // namespace
}  // namespace beamid::experiments
