// The outlines of sections along a structure's elements.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/results/vtk/beam_grid.hpp"

namespace beamid::experiments {

/// Corners of the section at one end of an element, from the node there, counterclockwise seen against the
/// element's direction from first to second node; those of a sharp end coincide. An end of a space frame's
/// member lies beyond its offset.
/// @param picture one with a beam or a space frame
std::vector<Eigen::Vector3d> section_corners(const Picture& picture, const fem::Mesh::Element& element,
                                             bool at_second);

}  // namespace beamid::experiments
