// Natural frequencies of a space frame of uniform members without a mesh, the oracle of its finite elements.
#pragma once

#include "fem/space_frame.hpp"

namespace beamid::fem {

/// Frequency [Hz] of mode i, from 1 on, by bisection between 1e-3 Hz and 1e4 Hz on the count of natural
/// frequencies below [wittrick1971]: those of the members with all ends held, and the negative eigenvalues of
/// the frame's dynamic stiffness, whose members bend in two planes, stretch and twist as those of
/// exact_frame.hpp do. Shear, rotary inertia, springs, releases, axial loads and all offsets are left out.
double exact_frequency(const SpaceFrame& frame, int i);

}  // namespace beamid::fem
