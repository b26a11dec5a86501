#include "tests/fem/five_beams.hpp"

namespace beamid::test {

fem::Cantilever steel_beam(double tip_mass) {
  fem::Cantilever beam;
  beam.length = 1.10;
  beam.bending_stiffness = 2.12e11 * fem::rectangle_second_moment(0.060, 0.006);
  beam.mass_per_length = 3.055 / 1.10;
  beam.tip_mass = tip_mass;
  return beam;
}

}  // namespace beamid::test
