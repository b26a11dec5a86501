// One beam element: flexibility, stiffness and mass.
#pragma once

#include <Eigen/Core>
#include <optional>

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
/// which for a uniform Euler-Bernoulli element is h^3/EI [1/3 -1/2; -1/2 1]. The mass is that of the static
/// shapes, exact for any variation as well (element_shapes.hpp). A section that vanishes at one end (a sharp
/// tip) has no flexibility; its stiffness is then integrated over Hermite's cubics, and its shear neglected.
///
/// An axial load P subtracts P/h times the integral of (dw/ds)^2, in two parts: one on these strains, and one
/// on the chord, w_2 - w_1, which becomes a third strain of rigidity -P/h.
///
/// Static shapes cannot follow what inertia forces do inside the element. Bent, that costs (h/L)^4; sheared,
/// it costs (h/L)^2. A Timoshenko element with consistent mass therefore has two coordinates of its own, the
/// amplitudes of its answers to a uniform force and to a uniform couple. Static shapes do no work on them, so
/// that they are their own strains, and the order is four again.
struct ElementMatrices {
  Eigen::Matrix2d rigidity;     ///< D [N/m]
  Eigen::Matrix2d flexibility;  ///< D^-1 [m/N]
  Eigen::Matrix4d mass;         ///< of (w_1, h theta_1, w_2, h theta_2) [kg]

  /// The same with the interior coordinates a [m] behind the strains and behind the nodes'.
  struct Interior {
    Eigen::Matrix4d rigidity, flexibility;
    Eigen::Matrix<double, 6, 6> mass;
  };
  std::optional<Interior> interior;
};

/// Whether the element has interior coordinates.
bool has_interior(const Section& section, const Mesh::Element& element, MassModel mass_model);

/// @param added mass per length that rides on the element [kg/m].
ElementMatrices element_matrices(const Section& section, const Mesh::Element& element, double added,
                                 double axial_load, MassModel mass_model);

}  // namespace beamid::fem
