// What VTK draws of a beam: points fixed to its nodes, and the cells between them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/results/vtk/nodal_motion.hpp"
#include "fem/structural_system.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments {

/// What to draw, and how. It refers to what it is given, which must outlive it.
struct Picture {
  /// The line that the mesh is: a beam along x, a frame in the plane of x and z, or one in space.
  Picture(const fem::StructuralSystem& of_system) : system(of_system) {}

  /// With the beam or space frame that the system was assembled from also its stiffness and its bodies; with
  /// `draws_surface` its real sections.
  Picture(const fem::Structure& structure, const fem::StructuralSystem& of_system, bool draws_surface = false)
      : system(of_system),
        beam(structure.is_beam() ? &structure.beam() : nullptr),
        space_frame(structure.space_frame()),
        surface(draws_surface && (beam != nullptr || space_frame != nullptr)) {}
  Picture(const fem::Beam& of_beam, const fem::StructuralSystem& of_system, bool draws_surface = false)
      : system(of_system), beam(&of_beam), surface(draws_surface) {}

  const fem::StructuralSystem& system;
  const fem::Beam* beam = nullptr;
  const fem::SpaceFrame* space_frame = nullptr;
  bool surface = false;
};

/// Points and cells in space [m]: x along the beam, z its direction of bending. A plane frame's y becomes z;
/// a space frame keeps its axes.
///
/// As lines: one for each element, and a vertex at the centre of mass of each body. As a surface: the outline
/// of the section (fem::Outline) extruded through every segment, of quadrilaterals, closed at both ends, an
/// ellipse having 24 sides; and each body as a cube of steel, 7850 kg/m3, of its mass, about its centre of
/// mass. A segment without an outline is drawn as a ribbon, 1/20 of the beam's length wide and 1/100 high, a
/// member of a space frame as the rectangle that has its E A and E I; a body without mass is not drawn. Of
/// plane frames there are lines alone.
///
/// Of more than 20,000 elements neighbours in the same segment and the same damage are drawn as one.
struct BeamGrid {
  struct Point {
    int node = 0;            ///< of the mesh
    Eigen::Vector3d offset;  ///< from that node, with which it moves as one rigid body [m]
  };
  struct Cell {
    std::size_t first_corner = 0;  ///< in `corners`
    int size = 0;                  ///< 1: vertex, 2: line, more: polygon
    int section = 0;               ///< number of the segment, from 1 on; 0: a body
    int element = 0;               ///< number of the element, from 1 on; 0: a body
    double bending_stiffness =
        0.0;              ///< in the middle of the element, what damage has left of it [N m2]; 0: a body
    double damage = 0.0;  ///< the part of the bending stiffness that is lost
    double mass = 0.0;    ///< of the body [kg]; 0: the beam
  };
  std::vector<Point> points;
  std::vector<Cell> cells;
  std::vector<int> corners;  ///< points of the cells, cell after cell
  Eigen::Matrix3Xd nodes;    ///< place of every node of the mesh [m]

  Eigen::Vector3d place(std::size_t point) const {
    return nodes.col(points[point].node) + points[point].offset;
  }
};

/// @throws std::invalid_argument when the system has no mesh (a reduced one).
BeamGrid beam_grid(const Picture& picture);

/// Motion of the grid's points, translation + rotation x offset: a section stays plane, (-z theta, 0, w), and
/// a body beyond the tip by e moves w + e theta. (3 x points)
Eigen::Matrix3Xd translation_of_points(const BeamGrid& grid, const NodalMotion& motion);

/// (3 x points) [rad]
Eigen::Matrix3Xd rotation_of_points(const BeamGrid& grid, const NodalMotion& motion);

}  // namespace beamid::experiments
