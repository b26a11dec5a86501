// One element that stretches or twists.
#pragma once

#include <Eigen/Core>

#include "fem/mesh.hpp"

namespace beamid::fem {

/// Of the two nodal displacements u along the element: strain u_2 - u_1. The flexibility is h times the mean
/// of 1/EA, exact for any variation; the mass is that of the static shapes, in which the elongation spreads
/// as 1/EA does, or half at each node.
///
/// Static shapes cannot follow the inertia force omega^2 rho A u inside the element, which costs
/// (omega h)^2 rho A / (24 EA) of a frequency, at joints and along members alike. With consistent mass the
/// element therefore has an interior coordinate a, the displacement 4 s (1 - s) a beyond the static one: a
/// quadratic element, which errs by (omega h)^4 (rho A / EA)^2 / 1440. Static shapes do no work on it, so
/// that it is a strain of its own, of rigidity 16 EA / 3h.
///
/// A rod in torsion is the same with GJ and rho I_p in place of EA and rho A, and rotations in place of
/// displacements. A rod that is sharp at one end stretches without bound there; it is given linear
/// displacements and no interior coordinate.
struct RodMatrices {
  Eigen::VectorXd rigidity, flexibility;  ///< [N/m], [m/N] of the strains, which are not coupled (1 or 2)
  Eigen::MatrixXd mass;                   ///< [kg] of (u_1, u_2) or (u_1, u_2, a)

  Eigen::Index inside() const { return rigidity.size() - 1; }  ///< interior coordinates, 0 or 1
};

/// @param section of which only the taper is asked, for the steps of the integration
RodMatrices rod_matrices(const Section& section, const Mesh::Element& element, const Variation& stiffness,
                         const Variation& mass_per_length, MassModel mass_model);

}  // namespace beamid::fem
