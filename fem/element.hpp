// One beam element: flexibility, stiffness and mass.
#pragma once

#include <Eigen/Core>

#include "fem/mesh.hpp"

namespace beamid::fem {

/// Matrices of one element of length h between nodes 1 and 2.
///
/// Natural strains: the drift of node 2 from the tangent at node 1, and the change of rotation, both zero in
/// rigid motions,
///
///     epsilon = (h theta_1 - (w_2 - w_1),  h theta_2 - h theta_1)   [m],
///
/// and their conjugate forces (shear force, bending moment at node 2 over h) [N]. The flexibility is exact
/// for any variation of the section, shear included:
///
///     F = h^3 integral_0^1 b b^T / EI ds + (h / kappa G A) [1 0; 0 0],   b = (s - 1, 1)
///
/// which for a uniform Euler-Bernoulli element is h^3/EI [1/3 -1/2; -1/2 1]. A section that vanishes at one
/// end (a sharp tip) has no flexibility; its stiffness is then integrated over Hermite's cubics. An axial
/// load P subtracts P/h times the integral of (dw/ds)^2, in two parts: one on these strains, and one on the
/// chord, w_2 - w_1, which becomes a third strain of rigidity -P/h.
struct ElementMatrices {
  Eigen::Matrix2d rigidity;     ///< D [N/m]
  Eigen::Matrix2d flexibility;  ///< D^-1 [m/N]
  Eigen::Matrix4d mass;         ///< of (w_1, h theta_1, w_2, h theta_2) [kg]
};

/// @param added mass per length that rides on the element [kg/m].
ElementMatrices element_matrices(const Section& section, const Mesh::Element& element, double added,
                                 double axial_load, MassModel mass_model);

}  // namespace beamid::fem
