#include "fem/frame.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fem/assembly.hpp"
#include "fem/complex_modes.hpp"
#include "fem/modes.hpp"
#include "fem/space_frame.hpp"
#include "fem/stiffness_solver.hpp"
#include "tests/fem/exact_frame.hpp"

namespace beamid::fem::frame_test {
namespace {

constexpr double pi = std::numbers::pi;

Section section(double bending, double axial, double mass) {
  return {bending, mass, 0.0, {}, axial, {}};
}

Frame turned(Frame frame, double angle) {
  for (Frame::Joint& joint : frame.joints)
    joint = {joint.x * std::cos(angle) - joint.y * std::sin(angle),
             joint.x * std::sin(angle) + joint.y * std::cos(angle)};
  return frame;
}

// Columns of 3 m clamped at the ground, a beam of 4 m on them.
Frame portal(double axial) {
  Frame frame;
  frame.joints = {{0, 0}, {0, 3}, {4, 3}, {4, 0}};
  frame.members = {
      {0, 1, section(2e5, axial, 20)}, {1, 2, section(5e5, axial, 30)}, {3, 2, section(2e5, axial, 20)}};
  frame.supports = {{0}, {3}};
  return frame;
}

// Oracle: the beam element's own assembly, of which the frame's bending is a second one. The stretching of a
// rod so stiff has no mode among the first six.
TEST(Frame, StraightMemberIsTheBeam) {
  Section tapered = section(0, 1e12, 0);
  tapered.bending_stiffness = Variation::linear(300, 100);
  tapered.mass_per_length = Variation::linear(3, 1);
  tapered.rotary_inertia = 0.01;
  tapered.shear_stiffness = 1e5;
  for (const MassModel mass_model : {MassModel::consistent, MassModel::lumped}) {
    Beam beam;
    beam.segments = {{1.5, tapered}};
    beam.supports = {{0.0, true, true}};
    beam.bodies = {{1.5, 0.4, 0.003, 0.0}};
    beam.mass_model = mass_model;
    Frame frame;
    frame.joints = {{0, 0}, {1.5, 0}};
    frame.members = {{0, 1, tapered}};
    frame.supports = {{0}};
    frame.bodies = {{1, 0.4, 0.003}};
    frame.mass_model = mass_model;
    const Modes of_beam = modes(assemble(beam, 20), 6), of_frame = modes(assemble(frame, 20), 6);
    for (int i = 0; i < 6; ++i)
      EXPECT_NEAR(of_frame.angular_frequency[i] / of_beam.angular_frequency[i], 1.0, 1e-12) << i;
    std::swap(frame.members[0].first, frame.members[0].second);  // the walk runs against the member
    std::swap(frame.joints[0], frame.joints[1]);
    frame.supports[0].joint = 1;
    frame.bodies[0].joint = 0;
    frame.members = {{1, 0, tapered}};
    EXPECT_NEAR(modes(assemble(frame, 20), 1).angular_frequency[0] / of_beam.angular_frequency[0], 1.0,
                1e-12);
    frame.members[0] = {0, 1, tapered};  // and now the taper is the other way round
    EXPECT_LT(modes(assemble(frame, 20), 1).angular_frequency[0], 0.9 * of_beam.angular_frequency[0]);
  }
}

// Oracle: the elements' exact dispersion. With t = (2n-1) pi h/(2L) and c = sqrt(EA/m) the frequency is x
// c/h, with lumped mass x = 2 sin(t/2). With consistent mass the interior coordinate a = r (u_1 + u_2), r =
// (x^2/3) / (16/3 - 8 x^2/15), is eliminated from (1 - x^2/3) u_1 - (1 + x^2/6) u_2 - x^2/3 a, so that (1 -
// x^2/3 - r x^2/3) = (1 + x^2/6 + r x^2/3) cos t. Both tend to t, which is exact.
TEST(Frame, RodFollowsTheElementsDispersion) {
  const double length = 2.0, axial = 8e6, mass = 5.0, c = std::sqrt(axial / mass);
  const int elements = 30;
  for (const MassModel mass_model : {MassModel::consistent, MassModel::lumped}) {
    const bool lumped = mass_model == MassModel::lumped;
    Frame frame;
    frame.joints = {{1, 1}, {1 + length * 0.6, 1 + length * 0.8}};
    frame.members = {{0, 1, section(1e9, axial, mass)}};
    frame.supports = {{0}};
    frame.mass_model = mass_model;
    const Modes found = modes(assemble(frame, elements), 3);
    for (int n = 1; n <= 3; ++n) {
      const double t = (2 * n - 1) * pi / (2 * elements), h = length / elements;
      double low = 0.9 * t, high = 1.1 * t;  // of x, on both sides of the root
      for (int i = 0; i < 60; ++i) {
        const double x = 0.5 * (low + high), y = x * x / 3, r = y / (16.0 / 3 - 8 * x * x / 15);
        (1 - y - r * y > (1 + 0.5 * y + r * y) * std::cos(t) ? low : high) = x;
      }
      const double expected = c / h * (lumped ? 2 * std::sin(t / 2) : low);
      EXPECT_NEAR(found.angular_frequency[n - 1] / expected, 1.0, 1e-11) << n;
      const double exact = (2 * n - 1) * pi / 2 * c / length;
      EXPECT_NEAR((expected / exact - 1) / (lumped ? -t * t / 24 : std::pow(t, 4) / 1440), 1.0, 0.1) << n;
    }
  }
}

// Oracle: exact dynamic stiffness. Bending and stretching err by h^4. Stiffer members than these would cost
// the oracle, which is assembled, its digits.
TEST(Frame, PortalConvergesToTheExactFrequencies) {
  for (const double axial : {1e11, 1e8}) {
    const Frame frame = portal(axial);
    const Modes coarse = modes(assemble(frame, 5), 5), fine = modes(assemble(frame, 10), 5);
    for (int i = 0; i < 5; ++i) {
      const double exact = exact_frequency(frame, i + 1);
      const double error = coarse.frequency_hz()[i] / exact - 1, finer = fine.frequency_hz()[i] / exact - 1;
      EXPECT_LT(finer, 2e-4) << i;
      EXPECT_GT(finer, 0.0) << i;
      EXPECT_NEAR(std::log2(error / finer), 4.0, 0.2) << i;
    }
  }
}

// Oracle: slope deflection of a portal that does not stretch: a sway force H moves the beam by
// H h^3/(24 EI_c) (4 + 6 k)/(1 + 6 k), k = (EI_b/L)/(EI_c/h). The axial stiffness is 1e10 times what bending
// needs, and costs no digits.
TEST(Frame, PortalSwaysAsSlopeDeflectionSays) {
  const StructuralSystem system = assemble(portal(1e16), 8, {{"corner", 1}});
  const double k = (5e5 / 4) / (2e5 / 3);
  const double expected = 27.0 / (24 * 2e5) * (4 + 6 * k) / (1 + 6 * k);
  EXPECT_NEAR(1.0 / static_stiffness(system) / expected, 1.0, 1e-9);
}

// Oracle: the same frame, turned.
TEST(Frame, FrequenciesDoNotDependOnTheDirection) {
  for (const double axial : {1e7, 1e9}) {
    const Modes upright = modes(assemble(portal(axial), 12), 6);
    for (const double angle : {0.3, 0.9, 2.5, pi / 2}) {
      const Modes leaning = modes(assemble(turned(portal(axial), angle), 12), 6);
      for (int i = 0; i < 6; ++i)
        EXPECT_NEAR(leaning.angular_frequency[i] / upright.angular_frequency[i], 1.0, 1e-10)
            << angle << ' ' << i;
    }
  }
}

// Oracle: equilibrium. A cantilever of a carries a hinge, from which a span of 2b runs to a roller; half of a
// force in the middle of the span hangs on the hinge: P/2 a^3/3EI there, half of that in the middle, and P
// (2b)^3/48EI more.
TEST(Frame, HingePassesNoMoment) {
  const double a = 1.5, b = 1.0, bending = 400.0;
  for (const double angle : {0.0, 0.7}) {
    Frame frame;
    frame.joints = {{0, 0}, {a, 0}, {a + b, 0}, {a + 2 * b, 0}};
    frame = turned(frame, angle);
    const Section bar = section(bending, 1e9, 1.0);
    frame.members = {{0, 1, bar}, {1, 2, bar, true, false}, {2, 3, bar}};
    frame.supports = {{0}, {3, true, true, false}};
    const StructuralSystem system = assemble(frame, 4, {{"middle", 2}});
    const Eigen::Vector2d across(-std::sin(angle), std::cos(angle));
    const Eigen::MatrixXd force = system.inputs.leftCols(2) * across;
    const double moved =
        across.dot(Eigen::VectorXd(system.outputs * StiffnessSolver(system.stiffness).solve(force)));
    EXPECT_NEAR(moved / (a * a * a / (12 * bending) + 8 * b * b * b / (48 * bending)), 1.0, 1e-10) << angle;
  }
}

// Oracle: two bars at the angle alpha to the ground, all joints hinged: k = 2 EA/L sin^2 alpha, and
// horizontally cos^2.
TEST(Frame, TrussCarriesByStretchingAlone) {
  Frame frame;
  frame.joints = {{0, 0}, {3, 4}, {6, 0}};
  const Section bar = section(100.0, 2e6, 1.0);
  frame.members = {{0, 1, bar, true, true}, {2, 1, bar, true, true}};
  frame.supports = {{0}, {2, true, true, false}};
  const StructuralSystem system = assemble(frame, 3, {{"top", 1}});
  EXPECT_NEAR(static_stiffness(system, 0, 0) / (2 * 2e6 / 5 * 0.36), 1.0, 1e-10);
  EXPECT_NEAR(static_stiffness(system, 1, 1) / (2 * 2e6 / 5 * 0.64), 1.0, 1e-10);
}

// Oracle: a rigid-body translation, whose inertia force is the whole mass; and the statics of a spring.
TEST(Frame, BaseAccelerationPushesTheWholeMass) {
  for (const MassModel mass_model : {MassModel::consistent, MassModel::lumped}) {
    Frame frame = turned(portal(1e8), 0.4);
    frame.supports.clear();
    frame.bodies = {{2, 7.0, 0.5}};
    frame.mass_model = mass_model;
    const StructuralSystem system = assemble(frame, 5);
    ASSERT_EQ(system.input_names.size(), 2u);
    Eigen::VectorXd along[2] = {Eigen::VectorXd::Zero(system.size()), Eigen::VectorXd::Zero(system.size())};
    for (Eigen::Index i = 0; i < system.size(); ++i) {
      if (system.coordinates[i].kind == Coordinate::Kind::axial) along[0][i] = 1;
      if (system.coordinates[i].kind == Coordinate::Kind::deflection) along[1][i] = 1;
    }
    const Eigen::MatrixXd inputs = system.inputs;
    for (int axis = 0; axis < 2; ++axis) {
      EXPECT_NEAR(along[axis].dot(inputs.col(axis)), -(20 * 6 + 30 * 4 + 7), 1e-10);
      EXPECT_NEAR(along[axis].dot(system.mass * along[axis]), 20 * 6 + 30 * 4 + 7, 1e-10);
      EXPECT_NEAR(along[axis].dot(inputs.col(1 - axis)), 0, 1e-10);
    }
  }
}

// Oracle: the frame hangs on springs so soft that they alone move: w^2 = k/m along x and y.
TEST(Frame, FloatsOnSoftSprings) {
  Frame frame = portal(1e9);
  frame.supports.clear();
  frame.springs = {{1, 3.0, 0.0, 0.0}, {2, 3.0, 0.0, 0.0}, {0, 0.0, 4.0, 0.0}, {3, 0.0, 4.0, 0.0}};
  const Modes found = modes(assemble(frame, 6), 4);
  EXPECT_EQ(found.rigid, 0);
  EXPECT_GT(found.angular_frequency[3], 100 * found.angular_frequency[2]);
  // Up and down moves nothing else.
  const double heave = std::sqrt(8.0 / 240);
  EXPECT_NEAR((found.angular_frequency.head(3).array() - heave).abs().minCoeff(), 0.0, 1e-6);
}

// Oracle: three motions of a rigid body, whatever the angle, one loop or none.
TEST(Frame, FreeFrameHasThreeRigidBodyModes) {
  Frame frame = turned(portal(1e8), 0.4);
  frame.supports.clear();
  Frame ring = frame;
  ring.members.push_back({0, 3, section(1e5, 1e8, 10)});
  for (const Frame& shape : {frame, ring}) {
    const StructuralSystem system = assemble(shape, 7);
    EXPECT_EQ(StiffnessSolver(system.stiffness).rigid_motions().cols(), 3);
    const Modes found = modes(system, 5);
    EXPECT_EQ(found.rigid, 3);
    EXPECT_EQ(found.angular_frequency.head(3), Eigen::Vector3d::Zero());
    EXPECT_NEAR(found.frequency_hz()[3] / exact_frequency(shape, 4), 1.0, 1e-4);
  }
}

// Oracle: the exact dynamic stiffness, with members that no walk lists in their order: two storeys with a
// brace.
TEST(Frame, StoreysWithABraceConvergeToTheExactFrequencies) {
  const Section bar = section(3e5, 4e8, 25);
  Frame frame;
  frame.joints = {{0, 0}, {5, 0}, {0, 3}, {5, 3}, {0, 6}, {5, 6}};
  frame.members = {{4, 5, bar}, {2, 3, bar}, {0, 2, bar}, {3, 1, bar}, {5, 3, bar}, {2, 4, bar}, {0, 3, bar}};
  frame.supports = {{0}, {1, true, true, false}};
  const StructuralSystem system = assemble(frame, 16);
  EXPECT_TRUE(StiffnessSolver(system.stiffness).is_chain());
  const Modes found = modes(system, 8);
  for (int i = 0; i < 8; ++i)
    EXPECT_NEAR(found.frequency_hz()[i] / exact_frequency(frame, i + 1), 1.0, 5e-5) << i;
}

TEST(Frame, PinnedColumnSoftensUnderItsLoad) {
  // Oracle: omega^2 = omega_0^2 (1 - P / P_E), P_E = pi^2 E I / L^2, exact for a uniform pinned column.
  const double bending = 2e5, length = 3.0, mass = 20.0, euler = pi * pi * bending / (length * length);
  Frame frame;
  frame.joints = {{0, 0}, {0, length}};
  frame.members = {{0, 1, section(bending, 1e10, mass)}};
  frame.supports = {{0, true, true, false}, {1, true, false, false}};
  const double unloaded = std::pow(pi / length, 2) * std::sqrt(bending / mass);
  for (const double share : {-0.5, 0.3, 0.9}) {
    frame.members[0].axial_load = share * euler;
    const double found = modes(assemble(frame, 40), 1).angular_frequency[0];
    EXPECT_NEAR(found / (unloaded * std::sqrt(1.0 - share)), 1.0, 1e-6) << share;
  }
  frame.members[0].axial_load = 0.5 * euler;
  EXPECT_NEAR(*buckling_factor(frame, 20), 2.0, 1e-5);
}

TEST(Frame, PortalUnderLoadBucklesAsItsCharacteristicEquationSays) {
  // Oracle: a fixed-base portal whose columns bear P each sways out at the least k with
  // k h / tan(k h) = -6 (I_b / b) / (I_c / h), P = E I_c k^2, where nothing stretches [timoshenko1961].
  Frame frame = portal(1e12);
  const double h = 3.0, ratio = 6.0 * (5e5 / 4.0) / (2e5 / 3.0);
  double low = 0.5 * pi + 1e-9, high = pi - 1e-9;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (middle / std::tan(middle) + ratio > 0.0 ? low : high) = middle;
  }
  const double critical = 2e5 * low * low / (h * h);
  frame.members[0].axial_load = frame.members[2].axial_load = 0.5 * critical;
  EXPECT_NEAR(*buckling_factor(frame, 16), 2.0, 1e-4);
}

TEST(Frame, DashpotsDampAsThoseOfABeam) {
  // Oracle: complex modes of the same cantilever as a beam.
  Beam beam;
  beam.segments = {{1.5, section(300, 1e12, 2.0)}};
  beam.supports = {{0.0, true, true}};
  Dashpot dashpot;
  dashpot.position = 1.5;
  dashpot.translational = 4.0;
  beam.dashpots = {dashpot};
  Frame frame;
  frame.joints = {{0, 0}, {1.5, 0}};
  frame.members = {{0, 1, section(300, 1e12, 2.0)}};
  frame.supports = {{0}};
  frame.dashpots = {{1, 0.0, 4.0, 0.0}};
  const ComplexModes one = complex_modes(assemble(beam, 10), 2),
                     other = complex_modes(assemble(frame, 10), 2);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(std::abs(one.eigenvalue[i] / other.eigenvalue[i] - 1.0), 0.0, 1e-9);
}

TEST(Frame, MeshKeepsTheJointsAsItsFirstNodes) {
  const StructuralSystem system = assemble(portal(1e8), 4);
  ASSERT_EQ(system.mesh.nodes.size(), 4u + 3 * 3);
  ASSERT_EQ(system.mesh.elements.size(), 12u);
  EXPECT_EQ(system.mesh.nodes[2].x, 4);
  EXPECT_EQ(system.mesh.nodes[2].y, 3);
  for (const Mesh::Element& element : system.mesh.elements) {
    const Mesh::Node &a = system.mesh.nodes[element.first], &b = system.mesh.nodes[element.second];
    EXPECT_NEAR(std::hypot(b.x - a.x, b.y - a.y), element.length, 1e-15);
  }
  EXPECT_EQ(system.size(), 3 * (2 + 9) + 12);  // and one of each element's own
}

void expect_refusal(const Frame& frame, const std::string& message,
                    const std::vector<FramePoint>& points = {}) {
  try {
    assemble(frame, 2, points);
    FAIL() << "expected: " << message;
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()), message);
  }
}

TEST(Frame, RefusesTheImpossible) {
  expect_refusal({}, "the frame has no member; expected at least one");
  Frame frame = portal(1e8);
  frame.members[1].second = 7;
  expect_refusal(frame, "joint of member 1 is 7; expected one of the frame's, 0 to 3");
  frame = portal(1e8);
  frame.members[2].section.axial_stiffness.reset();
  expect_refusal(frame, "member 2 has no axial stiffness; expected E A [N], which a frame needs");
  frame = portal(1e8);
  frame.members[0].section.mass_per_length = -1;
  expect_refusal(frame, "member 0: mass per length is -1; expected a positive number of kg/m");
  frame = portal(1e8);
  frame.joints[1] = frame.joints[2];
  expect_refusal(frame, "member 1 has no length; expected joints at different places");
  frame = portal(1e8);
  frame.joints.push_back({9, 9});
  expect_refusal(frame, "joint 4 has no member; expected at least one");
  expect_refusal(portal(1e8), "point 'foot' is held by a support; expected one that can move", {{"foot", 0}});
  expect_refusal(portal(1e8), "point 'roof' is at joint 4; expected 0 to 3", {{"roof", 4}});
  EXPECT_THROW(assemble(portal(1e8), 0), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::fem::frame_test
