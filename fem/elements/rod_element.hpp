// One element that stretches or twists.
#pragma once

#include <Eigen/Core>

#include "fem/mesh.hpp"

namespace beamid::fem {

/// Of the two nodal displacements u along the element: strain u_2 - u_1. The flexibility is h times the mean
/// of 1/EA, exact for any variation; the mass is that of linear displacements, or half at each node. A rod in
/// torsion is the same with GJ and rho I_p in place of EA and rho A, and rotations in place of displacements.
struct RodMatrices {
  double rigidity, flexibility;  ///< [N/m], [m/N]
  Eigen::Matrix2d mass;          ///< [kg]
};

/// @param section of which only the taper is asked, for the steps of the integration
RodMatrices rod_matrices(const Section& section, const Mesh::Element& element, const Variation& stiffness,
                         const Variation& mass_per_length, MassModel mass_model);

}  // namespace beamid::fem
