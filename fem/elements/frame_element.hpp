// One element of a frame: what a beam element does, and its elongation.
#pragma once

#include <Eigen/Core>

#include "fem/mesh.hpp"

namespace beamid::fem {

/// Matrices of one element between nodes 1 and 2 in the frame's axes.
///
/// Coordinates: (u_1, v_1, h theta_1, u_2, v_2, h theta_2), and behind them the interior ones of bending (two
/// or none, element.hpp) and of stretching (one or none, rod_element.hpp). With the direction t of the
/// element, n = t turned by 90 degrees, and the strains of element.hpp, the strains here are
///
///     (t elongation - n epsilon_1, epsilon_2)   [m],
///
/// the interior coordinates themselves and, under an axial load P, the chord n (u_2 - u_1, v_2 - v_1) of
/// rigidity -P/h, last.
struct FrameElementMatrices {
  Eigen::MatrixXd strain;  ///< (3 x 6), with i interior ones (3 + i x 6 + i), a row more with P
  Eigen::MatrixXd rigidity, flexibility;  ///< [N/m], [m/N], of the strains
  Eigen::MatrixXd mass;                   ///< [kg], of the coordinates
};

/// @param direction t, of length 1.
/// @param section with an axial stiffness; @param axial_load P [N], positive in compression
FrameElementMatrices frame_element_matrices(const Section& section, const Mesh::Element& element,
                                            const Eigen::Vector2d& direction, double axial_load,
                                            MassModel mass_model);

}  // namespace beamid::fem
