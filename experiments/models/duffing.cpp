// The Duffing oscillator: a stiffness that grows, or with K3 < 0 shrinks, with the square of the amplitude,
//
//     M x'' + C x' + K x + K3 x^3 = e f
//
// The spring is that of springs/duffing.cpp. At the amplitude a it moves at omega^2 = (K + 3/4 K3 a^2) / M,
// to first order in K3.
#include "experiments/models/motion/oscillator_motion.hpp"

namespace beamid::experiments {
namespace {

std::unique_ptr<JointModel> make_duffing(const ModelSetting& setting, const filters::Options& options) {
  constexpr double stiffness_uncertainty = 0.3;
  const ExpectedOscillator beam = expected_oscillator("duffing", setting);
  // One per cent of K at the usual amplitude, and a hundred times as uncertain: of either sign.
  const double cubic = 0.01 * beam.stiffness / (beam.amplitude * beam.amplitude);
  return make_oscillator(
      "duffing", setting, spring_and_dashpot(spring_law_registry().make("duffing", {})),
      {{"stiffness", beam.stiffness, stiffness_uncertainty * beam.stiffness, true},
       {"damping", beam.damping, beam.damping, true},
       {"cubic_stiffness", cubic, 100.0 * cubic, false, true, options.number("cubic_stiffness_n_per_m3")}},
      options.flag("sensor_bias"));
}

const bool duffing_registered = model_registry().add(
    {"duffing",
     "one degree of freedom with a cubic spring: K, C and K3 unknown, mass too where a force was measured",
     "[kovacic2011]",
     {{"sensor_bias", true, "", "estimate the constant offset of every accelerometer too"},
      {"cubic_stiffness_n_per_m3", 0.0, "N/m3", "where [[parameters]] do not request it"}},
     {},
     make_duffing});

}  // namespace
}  // namespace beamid::experiments
