// The five beams of the 2009 paper and what is assumed about them.
#pragma once

#include <array>

#include "experiments/rig/virtual_rig.hpp"
#include "fem/cantilever.hpp"

namespace beamid::experiments::paper {

struct TestBeam {
  const char* name;            ///< S(tip mass in per cent of the beam's)
  double tip_mass;             ///< [kg]
  double first_damping_ratio;  ///< ASSUMED: the paper's table is not available; "all below 0.5 %"
};

inline constexpr std::array<TestBeam, 5> test_beams{{{"S(0.65)", 0.0198575, 0.0020},
                                                     {"S(11.8)", 0.360490, 0.0045},
                                                     {"S(43.8)", 1.338090, 0.0028},
                                                     {"S(76.3)", 2.330965, 0.0022},
                                                     {"S(119.3)", 3.644615, 0.0015}}};

/// Steel, 1.10 m x 60 mm x 6 mm, 3.055 kg, E = 2.12e11 N/m2 [inverse2009].
inline fem::Cantilever steel_beam(const TestBeam& test) {
  fem::Cantilever beam;
  beam.length = 1.10;
  beam.bending_stiffness = 2.12e11 * fem::rectangle_second_moment(0.060, 0.006);
  beam.mass_per_length = 3.055 / beam.length;
  beam.tip_mass = test.tip_mass;
  return beam;
}

/// Pulled 12 mm at the tip and released; 25 s at 1000 samples/s [inverse2009].
inline Release release_of(const TestBeam& test) {
  Release release;
  release.beam = steel_beam(test);
  release.first_damping_ratio = test.first_damping_ratio;
  return release;
}

}  // namespace beamid::experiments::paper
