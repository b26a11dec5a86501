// What stands between a beam and the K and C that a pipeline reports.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>

namespace beamid::experiments {

/// One cause of error, off in the clean pipeline and on in the full one.
struct CauseText {
  const char* name;   ///< key of results
  const char* label;  ///< in a figure
  const char* on;     ///< what the full pipeline does
  const char* off;    ///< what the clean one does instead
};

/// In the order in which a measurement meets them, from the beam to the filter.
enum class Cause : std::size_t {
  amplitude_damping,
  higher_modes,
  sensor_mass,
  sensor_noise,
  sensor_bias,
  sampling,
  high_pass,
  integration,
  reduction,
  discretisation,
  initial_covariance,
  linearisation
};

inline constexpr std::size_t cause_count = 12;
using Causes = std::bitset<cause_count>;  ///< those that are on

inline constexpr std::array<CauseText, cause_count> causes{
    {{"amplitude_damping", "amplitude", "a small quadratic damping", "linear damping"},
     {"higher_modes", "modes", "all modes in the record", "the first mode alone"},
     {"sensor_mass", "mass", "a sensor whose mass nobody counted", "a weightless sensor"},
     {"sensor_noise", "noise", "white noise of the sensor", "none"},
     {"sensor_bias", "bias", "a constant offset of the sensor", "none"},
     {"sampling", "sampling", "the stated rate", "twice that rate"},
     {"high_pass", "high-pass", "causal high-pass, its transient kept", "none, or its transient left out"},
     {"integration", "integration", "displacement and velocity by integration", "acceleration observed"},
     {"reduction", "reduction", "Rayleigh's mass", "the first mode's own mass"},
     {"discretisation", "discretisation", "forward Euler", "the exact discretisation"},
     {"initial_covariance", "P0", "P0 = diag(1, 1, 1e5, 1e5)", "P0 as wide as the first guess errs"},
     {"linearisation", "one pass", "one pass over the record", "four passes"}}};

inline constexpr std::size_t index_of(Cause cause) {
  return static_cast<std::size_t>(cause);
}
inline Causes only(Cause cause) {
  return {1ULL << index_of(cause)};
}
inline Causes all_causes() {
  return Causes().set();
}

}  // namespace beamid::experiments
