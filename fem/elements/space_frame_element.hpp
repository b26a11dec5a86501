// One element of a space frame: two beam elements across each other, a rod and a shaft.
#pragma once

#include <Eigen/Core>

#include "fem/beam.hpp"
#include "fem/space_frame.hpp"

namespace beamid::fem {

/// Matrices of one element between nodes 1 and 2 in the frame's axes.
///
/// Coordinates: (d_1, h theta_1, d_2, h theta_2), each a vector along x, y and z, and behind them interior
/// ones: two (element.hpp) for bending in the plane of the member's x and y where it has shear deformation
/// there, two for bending in that of x and z, one (element.hpp) for stretching and one for twisting. The
/// natural strains are, t being the direction of the element,
///
///     h theta_2 - h theta_1   and   d_2 - d_1 - h theta_1 x t   [m],
///
/// both zero in rigid motions, and the interior coordinates. Along the member's own axes they are the twist
/// h (theta_2 - theta_1)_x of rigidity GJ/h^3, the elongation, and the strains of element.hpp of deflections
/// along y, (-[d]_y, [theta]_z), and along z, (-[d]_z, -[theta]_y).
///
/// An axial load P adds the chords along the member's y and z, of rigidity -P/h, last, and takes P (I_y +
/// I_z) / A from GJ: fibres at the distance r from the axis are inclined by r dtheta/dx where the member
/// twists [timoshenko1961]. That is exact of a section that is symmetric about both axes; (I_y + I_z) / A is
/// taken from its torsional inertia over its mass per length.
struct SpaceFrameElementMatrices {
  Eigen::MatrixXd strain;                 ///< (6 x 12), with i interior ones (6 + i x 12 + i), two rows more
                                          ///< with P
  Eigen::MatrixXd rigidity, flexibility;  ///< [N/m], [m/N], of the strains
  Eigen::MatrixXd mass;                   ///< [kg], of the coordinates
};

/// @param axes of the member, as columns: x along it, y, z (SpaceFrame::axes)
/// @param axial_load P [N], positive in compression
SpaceFrameElementMatrices space_frame_element_matrices(const SpaceSection& section,
                                                       const Mesh::Element& element,
                                                       const Eigen::Matrix3d& axes, double axial_load,
                                                       MassModel mass_model);

}  // namespace beamid::fem
