// The steel cantilever that contracts are tested on: 1.10 m, 60 x 6 mm, 3.055 kg.
#pragma once

#include "fem/beam.hpp"

namespace beamid::test {

/// @param tip_mass [kg]
inline fem::Cantilever steel_beam(double tip_mass) {
  fem::Cantilever beam;
  beam.length = 1.10;
  beam.bending_stiffness = 2.12e11 * fem::rectangle_second_moment(0.060, 0.006);
  beam.mass_per_length = 3.055 / 1.10;
  beam.tip_mass = tip_mass;
  return beam;
}

}  // namespace beamid::test
