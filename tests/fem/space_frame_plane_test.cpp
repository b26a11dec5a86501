// A plane frame as a special case of one in space.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "fem/complex_modes.hpp"
#include "fem/frame.hpp"
#include "fem/modes.hpp"
#include "fem/space_frame.hpp"
#include "fem/stiffness_solver.hpp"
#include "tests/fem/space_bars.hpp"

namespace beamid::fem::space_frame_plane_test {
namespace {

using Eigen::Index, Eigen::Vector3d;
using test::bar, test::cantilever;

SpaceSection with_plane(const Section& plane) {
  SpaceSection s = bar();
  s.axial_stiffness = (*plane.axial_stiffness)(0.0);
  s.bending_stiffness_z = plane.bending_stiffness(0.0);
  s.mass_per_length = plane.mass_per_length(0.0);
  s.rotary_inertia_z = plane.rotary_inertia(0.0);
  if (plane.shear_stiffness) s.shear_stiffness_y = (*plane.shear_stiffness)(0.0);
  return s;
}

// In the plane of x and y, where sections bend about their z.
SpaceFrame in_space(const Frame& plane) {
  SpaceFrame frame;
  for (const Frame::Joint& joint : plane.joints)
    frame.joints.push_back({{joint.x, joint.y, 0.0}, joint.name});
  for (const Frame::Member& member : plane.members) {
    frame.members.push_back({member.first, member.second, with_plane(member.section)});
    frame.members.back().at_first.z = member.hinged_at_first;
    frame.members.back().at_second.z = member.hinged_at_second;
    frame.members.back().stiffness_factor = member.stiffness_factor;
    frame.members.back().axial_load = member.axial_load;
  }
  for (const Frame::Support& s : plane.supports)
    frame.supports.push_back({s.joint, s.x, s.y, true, true, true, s.rotation});
  for (const Frame::Body& body : plane.bodies)
    frame.bodies.push_back(
        {body.joint, body.mass, Vector3d::Constant(body.rotary_inertia), Vector3d::Zero()});
  for (const Frame::Spring& spring : plane.springs)
    frame.springs.push_back({spring.joint, {spring.x, spring.y, 0.0}, {0.0, 0.0, spring.rotational}});
  for (const Frame::Dashpot& dashpot : plane.dashpots)
    frame.dashpots.push_back({dashpot.joint, {dashpot.x, dashpot.y, 0.0}, {0.0, 0.0, dashpot.rotational}});
  frame.mass_model = plane.mass_model;
  return frame;
}

// A portal with a brace, a hinge, a body, a spring and shear deformation in one member.
Frame braced_portal() {
  Section column{2e5, 20.0, 0.0, {}, 1e8, {}}, girder{5e5, 30.0, 0.02, 4e7, 1.3e8, {}};
  Frame frame;
  frame.joints = {{0, 0}, {0, 3}, {4, 3}, {4, 0}};
  frame.members = {{0, 1, column}, {1, 2, girder}, {3, 2, column}, {0, 2, column}};
  frame.members[3].hinged_at_first = frame.members[3].hinged_at_second = true;
  frame.members[2].stiffness_factor = 0.8;
  frame.supports = {{0}, {3, true, true, false}};
  frame.bodies = {{1, 200.0, 3.0}};
  frame.springs = {{2, 1e5, 0.0, 2e4}};
  return frame;
}

// Oracle: the plane frame, whose modes are among those of the same frame in space.
TEST(SpaceFrame, HasTheModesOfThePlaneFrame) {
  for (const MassModel mass_model : {MassModel::consistent, MassModel::lumped}) {
    Frame plane = braced_portal();
    plane.mass_model = mass_model;
    const Modes expected = modes(assemble(plane, 6), 6), found = modes(assemble(in_space(plane), 6), 24);
    for (Index i = 0; i < 6; ++i)
      EXPECT_LE((found.angular_frequency.array() / expected.angular_frequency[i] - 1.0).abs().minCoeff(),
                1e-10)
          << i;
  }
}

Frame loaded_portal() {
  Frame plane = braced_portal();
  plane.members[0].axial_load = 6e4, plane.members[1].axial_load = -2e4, plane.members[3].axial_load = 3e4;
  plane.dashpots = {{1, 3000.0, 0.0, 0.0}, {2, 0.0, 2000.0, 500.0}};
  return plane;
}

// Oracle: the plane frame, whose modes under axial loads are among those of the same frame in space.
TEST(SpaceFrame, SoftensUnderAxialLoadsAsThePlaneFrameDoes) {
  const Frame plane = loaded_portal();
  Frame unloaded = plane;
  for (Frame::Member& member : unloaded.members) member.axial_load = 0.0;
  const Modes expected = modes(assemble(plane, 6), 6), found = modes(assemble(in_space(plane), 6), 24);
  EXPECT_LT(expected.angular_frequency[0] / modes(assemble(unloaded, 6), 1).angular_frequency[0], 0.99);
  for (Index i = 0; i < 6; ++i)
    EXPECT_LE((found.angular_frequency.array() / expected.angular_frequency[i] - 1.0).abs().minCoeff(), 1e-10)
        << i;
}

// Oracle: the plane frame, whose decaying motions are among those of the same frame in space.
TEST(SpaceFrame, DashpotsDampAsThoseOfThePlaneFrame) {
  const Frame plane = loaded_portal();
  const ComplexModes expected = complex_modes(assemble(plane, 4), 4),
                     found = complex_modes(assemble(in_space(plane), 4), 16);
  EXPECT_GT(expected.damping_ratio().maxCoeff(), 1e-3);
  for (Index i = 0; i < 4; ++i)
    EXPECT_LE((found.eigenvalue.array() / expected.eigenvalue[i] - 1.0).abs().minCoeff(), 1e-9) << i;
}

// Oracle: J theta'' + c theta' + k theta = 0 and m w'' + c w' + k w = 0 of a body on springs and dashpots
// about and along each axis, lambda = -c/2m + i sqrt(k/m - (c/2m)^2). What carries it weighs and resists
// nothing.
TEST(SpaceFrame, BodyOnSpringsAndDashpotsDecaysInItsSixMotions) {
  SpaceFrame frame = cantilever(bar());
  SpaceSection& s = frame.members[0].section;
  for (double* const number : {&s.axial_stiffness, &s.bending_stiffness_y, &s.bending_stiffness_z,
                               &s.torsional_stiffness, &s.mass_per_length, &s.torsional_inertia})
    *number *= 1e-12;
  frame.bodies = {{1, 20.0, {3.0, 5.0, 7.0}, Vector3d::Zero()}};
  frame.springs = {{1, {2e3, 3e3, 5e3}, {700.0, 1.1e3, 1.3e3}}};
  frame.dashpots = {{1, {10.0, 30.0, 20.0}, {4.0, 9.0, 6.0}}};
  const ComplexModes found = complex_modes(assemble(frame, 1), 6);
  const auto expect_among = [&](double mass, double k, double c) {
    const double decay = c / (2 * mass);
    const std::complex<double> lambda(-decay, std::sqrt(k / mass - decay * decay));
    EXPECT_LE((found.eigenvalue.array() / lambda - 1.0).abs().minCoeff(), 1e-6) << lambda;
  };
  for (int i = 0; i < 3; ++i) {
    expect_among(20.0, frame.springs[0].translational[i], frame.dashpots[0].translational[i]);
    expect_among(frame.bodies[0].inertia[i], frame.springs[0].rotational[i], frame.dashpots[0].rotational[i]);
  }
}

// Oracle: the plane frame.
TEST(SpaceFrame, StandsAsThePlaneFrameDoes) {
  const Frame plane = braced_portal();
  const StructuralSystem expected = assemble(plane, 3, {{"corner", 1}}),
                         found = assemble(in_space(plane), 3, {{"corner", 1}});
  EXPECT_EQ(found.input_names[1], "corner_force_y");
  for (const Index i : {0, 1})
    for (const Index j : {0, 1})
      EXPECT_NEAR(static_stiffness(found, i, j) / static_stiffness(expected, i, j), 1.0, 1e-10);
}

}  // namespace
}  // namespace beamid::fem::space_frame_plane_test
