// Order of convergence of plane and space frames whose members stretch and twist as much as they bend.
// Oracle: the exact dynamic stiffness of the members and the count of Wittrick and Williams [wittrick1971].
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fem/frame.hpp"
#include "fem/modes.hpp"
#include "fem/space_frame.hpp"
#include "tests/fem/exact_frame.hpp"
#include "tests/fem/exact_space_frame.hpp"
#include "tests/fem/verification/oracle.hpp"

namespace beamid::frame_convergence_test {
namespace {

using std::numbers::pi;

// The error of each mode falls by 2^4 where elements are halved, and frequencies are upper bounds.
template <class AnyFrame>
void expect_order_four(const AnyFrame& frame, int elements, Eigen::Index count, double largest) {
  const fem::Modes coarse = fem::modes(fem::assemble(frame, elements), count),
                   fine = fem::modes(fem::assemble(frame, 2 * elements), count);
  for (Eigen::Index i = coarse.rigid; i < count; ++i) {
    const double exact = exact_frequency(frame, static_cast<int>(i) + 1),
                 error = coarse.frequency_hz()[i] / exact - 1.0, finer = fine.frequency_hz()[i] / exact - 1.0;
    EXPECT_GT(finer, 0.0) << i;
    EXPECT_LT(finer, largest) << i;
    EXPECT_NEAR(std::log2(error / finer), 4.0, 0.1) << "mode " << i + 1 << " of " << elements;
    test::record("finite_elements", finer);
  }
}

// EA L^2/EI = 45: members as thick as they may be, whose stretching is a third of the frequency's part.
fem::Frame stocky_portal() {
  const fem::Section column{2e5, 20.0, 0.0, {}, 1e6, {}}, girder{5e5, 30.0, 0.0, {}, 2e6, {}};
  fem::Frame frame;
  frame.joints = {{0, 0}, {0, 3}, {4, 3}, {4, 0}};
  frame.members = {{0, 1, column}, {1, 2, girder}, {3, 2, column}};
  frame.supports = {{0}, {3}};
  return frame;
}

TEST(FrameConvergence, PortalOfMembersThatStretch) {
  expect_order_four(stocky_portal(), 10, 8, 3e-5);
}

// Where joints bear bodies the inertia forces of members are not all there is.
TEST(FrameConvergence, PortalWithBodiesAtItsJoints) {
  fem::Frame frame = stocky_portal();
  frame.bodies = {{1, 60.0, 4.0}, {2, 15.0, 0.0}};
  expect_order_four(frame, 10, 8, 3e-5);
}

TEST(FrameConvergence, FreeSquareFrame) {
  const double side = 10.0, h = 0.25, e = 200e9, rho = 8000.0;
  const fem::Section bar{e * std::pow(h, 4) / 12, rho * h * h, 0.0, {}, e * h * h, {}};
  fem::Frame frame;
  frame.joints = {{0, 0}, {side, 0}, {side, side}, {0, side}};
  frame.members = {{0, 1, bar}, {1, 2, bar}, {2, 3, bar}, {3, 0, bar}};
  expect_order_four(frame, 10, 11, 2e-5);
}

// A rod with a body M at its end, which half lumped mass errs on by h^2: x tan x = m L / M.
TEST(FrameConvergence, RodWithABody) {
  const double length = 2.0, axial = 8e6, mass = 5.0, body = 4.0;
  fem::Frame frame;
  frame.joints = {{0, 0}, {length, 0}};
  frame.members = {{0, 1, {1e9, mass, 0.0, {}, axial, {}}}};
  frame.supports = {{0}, {1, false, true, true}};
  frame.bodies = {{1, body, 0.0}};
  const double x = test::roots([&](double z) { return z * std::sin(z) - mass * length / body * std::cos(z); },
                               1)[0],
               exact = x / length * std::sqrt(axial / mass);
  const auto error = [&](int elements) {
    return fem::modes(fem::assemble(frame, elements), 1).angular_frequency[0] / exact - 1.0;
  };
  EXPECT_NEAR(error(8) / (std::pow(x / 8, 4) / 1440), 1.0, 0.6);
  EXPECT_NEAR(std::log2(error(4) / error(8)), 4.0, 0.05);
}

// A rod whose stiffness and mass fall linearly to a fifth: its static shapes are no straight lines. Oracle: u
// = A J_0(k z) + B Y_0(k z), z the distance from where the section would vanish, clamped at 5 z_1, free at
// z_1.
TEST(FrameConvergence, TaperedRod) {
  const double length = 2.0, axial = 8e6, mass = 5.0, tip = 0.2, near = length * tip / (1 - tip);
  fem::Section section{1e9, 0.0, 0.0, {}, {}, {}};
  section.mass_per_length = fem::Variation::linear(mass, tip * mass);
  section.axial_stiffness = fem::Variation::linear(axial, tip * axial);
  fem::Frame frame;
  frame.joints = {{0, 0}, {length, 0}};
  frame.members = {{0, 1, section}};
  frame.supports = {{0}, {1, false, true, true}};
  const auto equation = [&](double k) {
    const double far = near + length;
    return std::cyl_bessel_j(0, k * far) * std::cyl_neumann(1, k * near) -
           std::cyl_neumann(0, k * far) * std::cyl_bessel_j(1, k * near);
  };
  const double exact = test::roots(equation, 1, 0.01, 0.05)[0] * std::sqrt(axial / mass);
  for (const bool reversed : {false, true}) {
    if (reversed) {  // the walk goes against the member
      std::swap(frame.joints[0], frame.joints[1]);
      frame.members[0].first = 1, frame.members[0].second = 0;
      frame.supports = {{1}, {0, false, true, true}};
    }
    const auto error = [&](int elements) {
      return fem::modes(fem::assemble(frame, elements), 1).angular_frequency[0] / exact - 1.0;
    };
    EXPECT_GT(error(16), 0.0);
    EXPECT_LT(error(16), 1e-6);
    EXPECT_NEAR(std::log2(error(8) / error(16)), 4.0, 0.1);
  }
}

// Four legs that lean, with bodies that turn, a grid of girders on them: bending, stretching and torsion are
// coupled, and torsion alone is as soft as bending.
TEST(FrameConvergence, SpaceFrameWithBodiesAtItsJoints) {
  fem::SpaceSection bar;
  bar.axial_stiffness = 4e6;
  bar.bending_stiffness_y = 1.05e6, bar.bending_stiffness_z = 3.78e5;
  bar.torsional_stiffness = 5e4;
  bar.mass_per_length = 47.1;
  bar.torsional_inertia = 0.8;
  fem::SpaceFrame frame;
  frame.joints = {{{0, 0, 0}, ""},     {{3.1, 0, 0.1}, ""}, {{3, 2.4, 0}, ""},    {{-0.2, 2, 0}, ""},
                  {{0.2, 0.1, 3}, ""}, {{3, 0.3, 2.8}, ""}, {{2.7, 2.2, 3.1}, ""}};
  for (const auto& [first, second] : {std::pair{0, 4}, {1, 5}, {2, 6}, {3, 4}, {4, 5}, {5, 6}, {6, 4}})
    frame.members.push_back({first, second, bar});
  frame.supports = {{0}, {1}, {2}, {3}};
  frame.bodies = {{4, 200.0, {6.0, 9.0, 4.0}, Eigen::Vector3d::Zero()},
                  {6, 50.0, {0.0, 1.0, 0.5}, Eigen::Vector3d::Zero()}};
  expect_order_four(frame, 12, 12, 3e-5);
}

}  // namespace
}  // namespace beamid::frame_convergence_test
