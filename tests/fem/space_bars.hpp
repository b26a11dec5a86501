// Members of steel that tests of space frames share.
#pragma once

#include "fem/space_frame.hpp"

namespace beamid::fem::test {

// Steel, 60 mm wide along y and 100 mm high along z.
inline SpaceSection bar() {
  SpaceSection s;
  s.axial_stiffness = 1.26e9;
  s.bending_stiffness_y = 1.05e6, s.bending_stiffness_z = 3.78e5;
  s.torsional_stiffness = 3.6e5;
  s.mass_per_length = 47.1;
  s.torsional_inertia = 0.0534;
  return s;
}

inline SpaceSection sheared_bar() {
  SpaceSection s = bar();
  s.rotary_inertia_y = 0.03925, s.rotary_inertia_z = 0.01413;
  s.shear_stiffness_y = s.shear_stiffness_z = 4.1e8;
  return s;
}

// Of 2 m along x, clamped at its first joint.
inline SpaceFrame cantilever(const SpaceSection& section) {
  SpaceFrame frame;
  frame.joints = {{{0, 0, 0}, ""}, {{2, 0, 0}, ""}};
  frame.members = {{0, 1, section}};
  frame.supports = {{0}};
  return frame;
}

}  // namespace beamid::fem::test
