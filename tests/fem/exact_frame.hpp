// Natural frequencies of a frame of uniform members without a mesh, the oracle of the frame's finite
// elements.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <vector>

#include "fem/frame.hpp"

namespace beamid::fem {

/// Dynamic stiffness of a uniform Euler-Bernoulli member that also stretches, rotary inertia left out. With
/// b^4 = m w^2/EI and a^2 = m w^2/EA, the end forces of w'''' = b^4 w and u'' = -a^2 u for end displacements
/// (u_1, w_1, theta_1, u_2, w_2, theta_2) of unit size.
Eigen::Matrix<double, 6, 6> dynamic_stiffness(double length, double bending, double axial, double mass,
                                              double w);

/// How many natural frequencies lie below w: those of the members with all ends held, and the negative
/// eigenvalues of the frame's dynamic stiffness [wittrick1971]. Joints are rigid; springs, hinges and axial
/// loads are left out.
int frequencies_below(const Frame& frame, double w);

/// Frequency [Hz] of mode i, from 1 on, by bisection on the count between 1e-3 Hz and 1e4 Hz.
double exact_frequency(const Frame& frame, int i);

}  // namespace beamid::fem
