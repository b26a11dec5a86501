// Oracles: rigid motions, which move every point of a picture as one body, and the dimensions of a section.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "experiments/results/vtk/beam_grid.hpp"
#include "fem/section.hpp"

namespace beamid::experiments::space_frame_picture_test {
namespace {

using Eigen::Vector3d;

// An I-section and one without an outline, of which one begins beyond an offset and one runs against the
// walk.
fem::SpaceFrame bent() {
  fem::SpaceSection section;
  section.axial_stiffness = 12e6, section.bending_stiffness_y = 1e6, section.bending_stiffness_z = 4e6;
  section.torsional_stiffness = 1e6, section.mass_per_length = 10.0, section.torsional_inertia = 0.1;
  fem::SpaceFrame frame;
  frame.joints = {{{0, 0, 0}, ""}, {{1, 2, 0.5}, ""}, {{2, 2, 3}, ""}};
  frame.members = {{0, 1, section}, {2, 1, section}};
  frame.members[0].section.outline = fem::i_shape(0.1, 0.2, 0.01, 0.02).outline;
  frame.members[0].at_first.offset = {0.1, 0.0, 0.2};
  frame.bodies = {{2, 50.0, Vector3d::Zero(), {0.0, 0.3, 0.0}}};
  return frame;
}

Eigen::VectorXd rigid_motion(const fem::StructuralSystem& system, const Vector3d& shift,
                             const Vector3d& turn) {
  using Kind = fem::Coordinate::Kind;
  Eigen::VectorXd q = Eigen::VectorXd::Zero(system.size());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const fem::Coordinate& c = system.coordinates[static_cast<std::size_t>(i)];
    if (c.node < 0) continue;
    const fem::Mesh::Node& node = system.mesh.nodes[static_cast<std::size_t>(c.node)];
    const Vector3d moved = shift + turn.cross(Vector3d(node.x, node.y, node.z));
    q[i] = c.kind == Kind::axial        ? moved.x()
           : c.kind == Kind::deflection ? moved.y()
           : c.kind == Kind::lateral    ? moved.z()
           : c.kind == Kind::rotation_x ? c.scale * turn.x()
           : c.kind == Kind::rotation_y ? c.scale * turn.y()
                                        : c.scale * turn.z();
  }
  return q;
}

TEST(SpaceFramePicture, MovesAsOneBodyInARigidMotion) {
  const fem::Structure frame = bent();
  const fem::StructuralSystem system = fem::assemble(*frame.space_frame(), 3);
  const Vector3d shift(0.1, -0.2, 0.3), turn(0.02, 0.01, -0.03);
  const NodalMotion motion = nodal_motion(system, rigid_motion(system, shift, turn));
  for (const bool surface : {false, true}) {
    const BeamGrid grid = beam_grid(Picture(frame, system, surface));
    const Eigen::Matrix3Xd moved = translation_of_points(grid, motion);
    for (std::size_t i = 0; i < grid.points.size(); ++i)
      EXPECT_LE((moved.col(static_cast<Eigen::Index>(i)) - shift - turn.cross(grid.place(i))).norm(), 1e-14)
          << i;
  }
}

TEST(SpaceFramePicture, SweepsTheSectionsFromEndToEnd) {
  const fem::Structure frame = bent();
  const fem::StructuralSystem system = fem::assemble(*frame.space_frame(), 3);
  const BeamGrid grid = beam_grid(Picture(frame, system, true));
  // rings of 12 corners and of 4, one more than elements; the body's cube
  ASSERT_EQ(grid.points.size(), 4u * 12 + 4 * 4 + 8);
  ASSERT_EQ(grid.cells.size(), 3u * 12 + 2 + 3 * 4 + 2 + 6);
  const Eigen::Matrix3d axes = frame.space_frame()->axes(0);
  const Vector3d first = axes.transpose() * (grid.place(0) - Vector3d(0.1, 0.0, 0.2));
  EXPECT_NEAR(first.x(), 0.0, 1e-15);
  EXPECT_NEAR(std::abs(first.y()), 0.05, 1e-15);
  EXPECT_NEAR(std::abs(first.z()), 0.1, 1e-15);
  // sqrt(12 I/A): 1 m along z and 2 m along y
  const Eigen::Matrix3d other = frame.space_frame()->axes(1);
  const Vector3d corner = other.transpose() * grid.points[4 * 12].offset;
  EXPECT_NEAR(std::abs(corner.y()), 1.0, 1e-14);
  EXPECT_NEAR(std::abs(corner.z()), 0.5, 1e-14);
}

// Oracle: Gauss's theorem, the volume within a closed surface whose normals point outwards: that of a tube
// drawn with 24 sides, times its length, whichever way its member runs.
TEST(SpaceFramePicture, HasNormalsThatPointOutwards) {
  for (const bool reversed : {false, true}) {
    fem::SpaceFrame frame = bent();
    frame.members.pop_back(), frame.joints.pop_back(), frame.bodies.clear();
    frame.members[0].at_first.offset.setZero();
    frame.members[0].section.outline = fem::tube_shape(0.3, 0.01, 0.3).outline;
    if (reversed) std::swap(frame.members[0].first, frame.members[0].second);
    frame.supports = {{0}};
    const fem::Structure structure = frame;
    const fem::StructuralSystem system = fem::assemble(frame, 2);
    const BeamGrid grid = beam_grid(Picture(structure, system, true));
    double volume = 0.0;
    for (const BeamGrid::Cell& cell : grid.cells)
      for (int k = 2; k < cell.size; ++k) {
        const auto corner = [&](int i) {
          return grid.place(
              static_cast<std::size_t>(grid.corners[cell.first_corner + static_cast<std::size_t>(i)]));
        };
        volume += corner(0).dot(corner(k - 1).cross(corner(k))) / 6.0;
      }
    const double polygon = 12.0 * std::sin(2.0 * M_PI / 24.0) * 0.15 * 0.15;
    EXPECT_NEAR(volume / (polygon * frame.length(0)), 1.0, 1e-12) << reversed;
  }
}

}  // namespace
}  // namespace beamid::experiments::space_frame_picture_test
