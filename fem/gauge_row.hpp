// What a strain gauge reads.
#pragma once

#include "fem/beam.hpp"
#include "fem/parametric_system.hpp"

namespace beamid::fem {

/// curvature_row() of a beam's system, better at a clamp: there neither inertia nor springs load the beam,
/// and M'' = M''' = 0 makes the curvature at the end of the element's own shape, which errs by h^2 elsewhere,
/// err by h^4 with a far smaller factor than the polynomial's (modes 1, 3 and 12 of a cantilever of 40
/// elements: 3e-8, 9e-6 and 4e-3 instead of 6e-7, 1.6e-4 and 3e-2). That needs consistent mass, a section
/// that is uniform along the element, and no axial load.
/// @throws std::invalid_argument as curvature_row()
SparseMatrix gauge_row(const StructuralSystem& system, const Beam& beam, double position);

}  // namespace beamid::fem
