// The experiment file of sweeps whose model is exact.
#pragma once

namespace beamid::test {

/// One mode below half the sampling rate, and the noise known.
inline constexpr const char* exact_rig = R"([beam]
length_m = 1.10
width_m = 0.060
height_m = 0.006
youngs_modulus_pa = 2.12e11
mass_kg = 3.055
tip_mass_kg = 0.36
elements = 8
[damping]
ratio = 0.01
[[sensors]]
name = "tip"
quantity = "displacement"
noise_m = 0.0003
[simulation]
duration_s = 4
sampling_rate_hz = 40
[reduction]
method = "modal_truncation"
[noise]
displacement_m = 0.0003
[compare]
passes = 1
)";

}  // namespace beamid::test
