#include "fem/space_frame.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fem/modes.hpp"
#include "fem/stiffness_solver.hpp"
#include "tests/fem/exact_space_frame.hpp"
#include "tests/fem/space_bars.hpp"

namespace beamid::fem::space_frame_test {
namespace {

using Eigen::Index, Eigen::Matrix3d, Eigen::Vector3d, Eigen::VectorXd;

using test::bar, test::cantilever, test::sheared_bar;

constexpr double pi = std::numbers::pi;

Matrix3d some_turn() {
  return (Eigen::AngleAxisd(0.7, Vector3d(1, 2, -0.5).normalized()) *
          Eigen::AngleAxisd(2.1, Vector3d::UnitY()))
      .toRotationMatrix();
}

// All of it, what points into directions included; supports have to hold all or nothing.
SpaceFrame turned(SpaceFrame frame, const Matrix3d& turn) {
  for (std::size_t i = 0; i < frame.members.size(); ++i)
    frame.members[i].section_z = turn * frame.axes(i).col(2), frame.members[i].roll = 0.0;
  for (SpaceFrame::Joint& joint : frame.joints) joint.place = turn * joint.place;
  for (SpaceFrame::Member& member : frame.members)
    for (SpaceFrame::End* const end : {&member.at_first, &member.at_second}) end->offset = turn * end->offset;
  for (SpaceFrame::Body& body : frame.bodies) body.offset = turn * body.offset;
  frame.base_direction = turn * frame.base_direction;
  return frame;
}

// A stair of three members, all of whose motions are coupled, with a loop back to the ground.
SpaceFrame stair() {
  SpaceFrame frame;
  frame.joints = {{{0, 0, 0}, ""}, {{0, 0, 3}, ""}, {{2, 0, 3}, ""}, {{2, 2.5, 2.5}, ""}, {{2, 2.5, 0}, ""}};
  frame.members = {{0, 1, bar()}, {2, 1, bar()}, {2, 3, bar()}, {3, 4, bar()}, {1, 3, bar()}};
  frame.members[2].roll = 0.4;
  frame.supports = {{0}, {4}};
  return frame;
}

// Oracle: (b L)^2 sqrt(EI/m)/L^2 with cos bL cosh bL = -1, from which Hermite's cubics err by (b h)^4/1440,
// and pi/2 sqrt(EA/m)/L, from which the quadratic rod errs by (a h)^4/1440, of stretching and torsion alike.
TEST(SpaceFrame, CantileverBendsAboutBothAxesStretchesAndTwists) {
  const double length = 2.0;
  const int elements = 24;
  const SpaceSection s = bar();
  const double t = pi / (2 * elements), rod = t * (1.0 + std::pow(t, 4) / 1440);
  const Modes found = modes(assemble(turned(cantilever(s), some_turn()), elements), 16);
  const auto expect_among = [&](double frequency, double tolerance) {
    EXPECT_LE((found.angular_frequency.array() / frequency - 1.0).abs().minCoeff(), tolerance) << frequency;
  };
  for (const double root : {1.8751040687119611, 4.6940911329741747, 7.8547574382376126})
    for (const double bending : {s.bending_stiffness_y, s.bending_stiffness_z})
      expect_among(root * root * std::sqrt(bending / s.mass_per_length) / (length * length) *
                       (1.0 + std::pow(root / elements, 4) / 1440),
                   1e-11 + 1e-4 * std::pow(root / elements, 6));
  expect_among(elements / length * rod * std::sqrt(s.torsional_stiffness / s.torsional_inertia), 1e-11);
  expect_among(elements / length * rod * std::sqrt(s.axial_stiffness / s.mass_per_length), 1e-11);
}

// Oracle: the same structure in other axes, with shear, releases, offsets and bodies off their joints.
TEST(SpaceFrame, FrequenciesDoNotDependOnTheDirection) {
  SpaceFrame frame = stair();
  for (SpaceFrame::Member& member : frame.members) member.section = sheared_bar();
  frame.members[0].section = bar();
  frame.members[1].at_second.y = true;
  frame.members[4].at_first.x = frame.members[4].at_first.y = frame.members[4].at_first.z = true;
  frame.members[2].at_first.offset = {0.1, -0.05, 0.2};
  frame.bodies = {{2, 150.0, Vector3d::Constant(4.0), {0.3, 0.2, -0.1}}};
  const Modes as_built = modes(assemble(frame, 8), 12),
              in_other_axes = modes(assemble(turned(frame, some_turn()), 8), 12);
  for (Index i = 0; i < 12; ++i)
    EXPECT_NEAR(in_other_axes.angular_frequency[i] / as_built.angular_frequency[i], 1.0, 1e-9) << i;
}

// Oracle: exact dynamic stiffness. Bending, stretching and torsion err by h^4.
TEST(SpaceFrame, StairConvergesToTheExactFrequencies) {
  const SpaceFrame frame = stair();
  const Modes coarse = modes(assemble(frame, 8), 8), fine = modes(assemble(frame, 16), 8);
  for (int i = 0; i < 8; ++i) {
    const double exact = exact_frequency(frame, i + 1);
    const double error = coarse.frequency_hz()[i] / exact - 1, finer = fine.frequency_hz()[i] / exact - 1;
    EXPECT_GT(finer, 0.0) << i;
    EXPECT_LT(finer, 2e-4) << i;
    EXPECT_NEAR(std::log2(error / finer), 4.0, 0.1) << i;
  }
}

// Oracle: B r = 0 of six motions of a rigid body, and no more.
TEST(SpaceFrame, FreeFrameHasSixRigidBodyModes) {
  SpaceFrame frame = turned(stair(), some_turn());
  frame.supports.clear();
  frame.members[3].at_second.offset = {0.1, 0.2, 0.3};
  const StructuralSystem system = assemble(frame, 5);
  EXPECT_EQ(StiffnessSolver(system.stiffness).rigid_motions().cols(), 6);
  const Modes found = modes(system, 8);
  EXPECT_EQ(found.rigid, 6);
  EXPECT_GT(found.angular_frequency[6], 1.0);
  using Kind = Coordinate::Kind;
  for (int axis = 0; axis < 3; ++axis) {
    VectorXd moved = VectorXd::Zero(system.size()), rotated = moved;
    for (Index i = 0; i < system.size(); ++i) {
      const Coordinate& c = system.coordinates[static_cast<std::size_t>(i)];
      if (c.node < 0) continue;
      const Mesh::Node& node = system.mesh.nodes[static_cast<std::size_t>(c.node)];
      const Vector3d about = Vector3d::Unit(axis), swing = about.cross(Vector3d(node.x, node.y, node.z));
      int k = 0;
      for (const Kind kind : {Kind::axial, Kind::deflection, Kind::lateral}) {
        if (c.kind == kind) moved[i] = about[k], rotated[i] = swing[k];
        ++k;
      }
      k = 0;
      for (const Kind kind : {Kind::rotation_x, Kind::rotation_y, Kind::rotation}) {
        if (c.kind == kind) rotated[i] = c.scale * about[k];
        ++k;
      }
    }
    EXPECT_LE((system.stiffness.strain * moved).cwiseAbs().maxCoeff(), 1e-14) << axis;
    EXPECT_LE((system.stiffness.strain * rotated).cwiseAbs().maxCoeff(), 1e-14) << axis;
  }
}

// Oracle: a force F up at the end of an arm b across a cantilever a: F (a^3 + b^3)/3EI + F a b^2/GJ.
TEST(SpaceFrame, BentCantileverTwistsAsItMust) {
  const double a = 2.0, b = 0.7;
  SpaceFrame frame;
  frame.joints = {{{0, 0, 0}, ""}, {{a, 0, 0}, ""}, {{a, b, 0}, ""}};
  frame.members = {{0, 1, bar()}, {1, 2, bar()}};
  frame.supports = {{0}};
  const SpaceSection s = bar();
  const double expected =
      (a * a * a + b * b * b) / (3 * s.bending_stiffness_y) + a * b * b / s.torsional_stiffness;
  EXPECT_NEAR(1.0 / static_stiffness(assemble(frame, 4, {{"tip", 2}}), 2, 2) / expected, 1.0, 1e-11);
  // the arm as a rigid offset of the tip's joint
  SpaceFrame offset = frame;
  offset.joints[1].place = frame.joints[2].place;
  offset.joints.pop_back(), offset.members.pop_back();
  offset.members[0].at_second.offset = {0.0, -b, 0.0};
  const double stiff_arm = a * a * a / (3 * s.bending_stiffness_y) + a * b * b / s.torsional_stiffness;
  EXPECT_NEAR(1.0 / static_stiffness(assemble(offset, 4, {{"tip", 1}}), 2, 2) / stiff_arm, 1.0, 1e-11);
}

// Oracle: F L^3/3EI + F L/kappa G A, along both axes of the section, which a roll of a right angle swaps.
TEST(SpaceFrame, SectionTurnsWithItsRoll) {
  const SpaceSection s = sheared_bar();
  const double strong = 8.0 / (3 * s.bending_stiffness_y) + 2.0 / *s.shear_stiffness_z,
               weak = 8.0 / (3 * s.bending_stiffness_z) + 2.0 / *s.shear_stiffness_y;
  SpaceFrame frame = cantilever(s);
  EXPECT_NEAR(1.0 / static_stiffness(assemble(frame, 3, {{"tip", 1}}), 2, 2) / strong, 1.0, 1e-11);
  EXPECT_NEAR(1.0 / static_stiffness(assemble(frame, 3, {{"tip", 1}}), 1, 1) / weak, 1.0, 1e-11);
  frame.members[0].roll = pi / 2;
  EXPECT_NEAR(1.0 / static_stiffness(assemble(frame, 3, {{"tip", 1}}), 2, 2) / weak, 1.0, 1e-11);
  frame.members[0].roll = 0.0, frame.members[0].section_z = Vector3d(3.0, 2.0, 0.0);
  EXPECT_NEAR(1.0 / static_stiffness(assemble(frame, 3, {{"tip", 1}}), 2, 2) / weak, 1.0, 1e-11);
}

// Oracle: an upright member's section has its z along the frame's x.
TEST(SpaceFrame, SectionsOfColumnsHaveTheirOwnUp) {
  const SpaceFrame frame = stair();
  EXPECT_TRUE(frame.axes(0).col(2).isApprox(Vector3d::UnitX(), 1e-14));
  EXPECT_TRUE(frame.axes(1).col(2).isApprox(Vector3d::UnitZ(), 1e-14));
  for (std::size_t i = 0; i < frame.members.size(); ++i) {
    EXPECT_TRUE((frame.axes(i).transpose() * frame.axes(i)).isIdentity(1e-14));
    EXPECT_NEAR(frame.axes(i).determinant(), 1.0, 1e-14);
  }
}

// Oracle: a tripod of pin-ended legs, whose stiffness downwards is sum EA/L cos^2, whatever they bend like.
// At its top all members are released: without a rule the joint could turn without strain.
TEST(SpaceFrame, TripodOfPinEndedLegsIsATruss) {
  SpaceFrame frame;
  frame.joints = {{{0, 0, 2}, ""}};
  for (int leg = 0; leg < 3; ++leg) {
    frame.joints.push_back({{std::cos(2 * pi * leg / 3), std::sin(2 * pi * leg / 3), 0}, ""});
    frame.members.push_back({leg + 1, 0, bar()});
    SpaceFrame::Member& member = frame.members.back();
    member.at_first.y = member.at_first.z = true;
    member.at_second.x = member.at_second.y = member.at_second.z = true;
    frame.supports.push_back({leg + 1});
  }
  const double length = std::sqrt(5.0), cosine = 2.0 / length;
  const double expected = 3 * bar().axial_stiffness / length * cosine * cosine;
  const StructuralSystem system = assemble(frame, 2, {{"top", 0}});
  EXPECT_NEAR(static_stiffness(system, 2, 2) / expected, 1.0, 1e-9);
  EXPECT_GT(modes(system, 3).angular_frequency[0], 1.0);
}

// Oracle: tan bL = tanh bL of a clamped-pinned beam, bL = 3.926602, in both planes.
TEST(SpaceFrame, ReleasedEndIsPinned) {
  SpaceFrame frame = turned(cantilever(bar()), some_turn());
  frame.supports.push_back({1});
  frame.members[0].at_second.y = frame.members[0].at_second.z = true;
  const Modes found = modes(assemble(frame, 16), 2);
  const double root = 3.9266023120479193;
  const double weak = root * root * std::sqrt(bar().bending_stiffness_z / bar().mass_per_length) / 4.0;
  const double strong = root * root * std::sqrt(bar().bending_stiffness_y / bar().mass_per_length) / 4.0;
  EXPECT_NEAR(found.angular_frequency[0] / weak, 1.0, 1e-5);
  EXPECT_NEAR(found.angular_frequency[1] / strong, 1.0, 1e-5);
}

TEST(SpaceFrame, MeshKeepsTheJointsAsItsFirstNodes) {
  const StructuralSystem system = assemble(stair(), 4);
  ASSERT_EQ(system.mesh.nodes.size(), 5u + 5 * 3);
  EXPECT_TRUE(system.mesh.spatial);
  EXPECT_EQ(system.mesh.nodes[3].z, 2.5);
  EXPECT_EQ(system.size(), 6 * (3 + 15) + 2 * 20);  // and two of each element's own
  for (const Mesh::Element& element : system.mesh.elements) {
    const Mesh::Node &a = system.mesh.nodes[element.first], &b = system.mesh.nodes[element.second];
    EXPECT_NEAR(std::hypot(b.x - a.x, b.y - a.y, b.z - a.z), element.length, 1e-14);
  }
}

std::string refusal(const SpaceFrame& frame, const std::vector<SpaceFramePoint>& points = {}) {
  try {
    assemble(frame, 2, points);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing";
}

TEST(SpaceFrame, RefusesTheImpossible) {
  EXPECT_EQ(refusal({}), "the frame has no member; expected at least one");
  SpaceFrame frame = stair();
  frame.members[1].second = 7;
  EXPECT_EQ(refusal(frame), "joint of member 1 is 7; expected one of the frame's, 0 to 4");
  frame = stair();
  frame.joints[1].place = frame.joints[2].place;
  EXPECT_EQ(refusal(frame), "member 1 has no length; expected ends at different places");
  frame = stair();
  frame.members[0].section_z = Vector3d(0, 0, 2);
  EXPECT_EQ(refusal(frame),
            "member 0: the direction of its section's z is along the member; expected one across it");
  frame = stair();
  frame.members[2].section.torsional_stiffness = 0.0;
  EXPECT_EQ(refusal(frame), "member 2: torsional stiffness is 0; expected a positive number of N m2");
  frame = stair();
  frame.members[1].axial_load = std::nan("");
  EXPECT_EQ(refusal(frame), "axial load of member 1 is nan; expected a finite number of N");
  frame = stair();
  frame.dashpots = {{2, {0.0, -3.0, 0.0}, Vector3d::Zero()}};
  EXPECT_EQ(refusal(frame), "damping along y is -3; expected zero or a positive number of N s/m");
  frame = stair();
  frame.joints.push_back({{9, 9, 9}, ""});
  EXPECT_EQ(refusal(frame), "joint 5 has no member; expected at least one");
  frame.joints.push_back({{9, 9, 8}, ""});
  frame.members.push_back({5, 6, bar()});
  EXPECT_EQ(refusal(frame), "joint 5 is not connected with joint 0; expected members between all parts");
  EXPECT_EQ(refusal(stair(), {{"foot", 0}}), "point 'foot' is held by a support; expected one that can move");
  EXPECT_THROW(assemble(stair(), 0), std::invalid_argument);
}

// A member that no moment about its own axis holds at either end spins.
TEST(SpaceFrame, FindsAMechanism) {
  SpaceFrame frame = stair();
  frame.members[4].at_first.x = frame.members[4].at_second.x = true;
  EXPECT_EQ(StiffnessSolver(assemble(frame, 3).stiffness).rigid_motions().cols(), 1);
  EXPECT_THAT(
      [&] {
        static_shape(assemble(frame, 3, {{"there", 1}}));
      },
      testing::ThrowsMessage<std::runtime_error>(
          testing::HasSubstr("the structure can move without strain")));
}

}  // namespace
}  // namespace beamid::fem::space_frame_test
