// How much of a structure a motion of its base moves.
#pragma once

#include "fem/structural_system.hpp"

namespace beamid::fem {

/// E^T M^-1 E of one input [kg for the base's acceleration]: with E = -M r the r^T M r of the rigid motion r,
/// of which every mode takes its effective mass (phi^T E)^2, phi^T M phi = 1, and all modes the whole.
double moved_mass(const StructuralSystem& system, Eigen::Index input);

/// Part of it that coordinates hold, 0 to 1. @param shapes (n x r) with Phi^T M Phi = 1
double moved_share(const StructuralSystem& system, Eigen::Index input, const Eigen::MatrixXd& shapes);

}  // namespace beamid::fem
