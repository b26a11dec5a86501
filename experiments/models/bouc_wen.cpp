// The Bouc-Wen oscillator: part of the spring slips and remembers [wen1976],
//
//     M x'' + C x' + alpha K x + (1 - alpha) K h = e f
//     h' = x' - |h/l|^(n-1) (beta |x'| h + gamma x' |h|)
//
// The spring is that of springs/bouc_wen.cpp, which says what beta, gamma and l are.
#include "experiments/models/motion/oscillator_motion.hpp"

namespace beamid::experiments {
namespace {

std::unique_ptr<JointModel> make_bouc_wen(const ModelSetting& setting, const filters::Options& options) {
  constexpr double stiffness_uncertainty = 0.3, half = 0.5;
  auto spring =
      spring_law_registry().make("bouc_wen", {{"exponent", options.number("exponent")},
                                              {"reference_length_m", options.number("reference_length_m")}});
  const ExpectedOscillator beam = expected_oscillator("bouc_wen", setting);
  const double rate = half / beam.amplitude;  // yields at the usual amplitude
  return make_oscillator(
      "bouc_wen", setting, spring_and_dashpot(std::move(spring)),
      {{"stiffness", beam.stiffness, stiffness_uncertainty * beam.stiffness, true},
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
      {"post_yield_ratio", 0.5, "", "alpha where [[parameters]] do not request it"},
      {"hysteresis_beta_per_m", 0.0, "1/m", "beta, likewise"},
      {"hysteresis_gamma_per_m", 0.0, "1/m", "gamma, likewise"}},
     {},
     make_bouc_wen});

}  // namespace
}  // namespace beamid::experiments
