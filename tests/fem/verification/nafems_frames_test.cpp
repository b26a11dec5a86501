// The free-vibration benchmarks of plane frames [nafems1987]: E = 200 GPa, rho = 8000 kg/m3, members of
// square section, vibrating in their plane.
//
// Assumptions: Euler-Bernoulli, that is without shear and rotary inertia; members that stretch, EA = 200 GPa
// x area; consistent mass; rigid joints on the axes' intersections; pins hold both displacements and no
// rotation.
//
// Two oracles. The exact dynamic stiffness of the same members (tests/fem/exact_frame.hpp). And the published
// frequencies, which turn out to be those of members that do not stretch: the exact dynamic stiffness with EA
// a million times larger gives them to all their digits for the crosses and for two modes of the square
// frame.
#include <gtest/gtest.h>

#include "fem/modes.hpp"
#include "tests/fem/exact_frame.hpp"

namespace beamid::fem::nafems_frames_test {
namespace {

Section square(double side, double stiffer) {
  const double area = side * side;
  return {2e11 * rectangle_second_moment(side, side), 8000 * area, 0.0, {}, 2e11 * area * stiffer, {}};
}

// Arms of 5 m from a middle joint, their ends pinned.
Frame pin_ended_cross(int arms, double stiffer) {
  Frame frame;
  frame.joints = {{0, 0}};
  for (int i = 1; i <= arms; ++i) {
    const double angle = 2 * std::numbers::pi * (i - 1) / arms;
    frame.joints.push_back({5 * std::cos(angle), 5 * std::sin(angle)});
    frame.members.push_back({0, i, square(0.125, stiffer)});
    frame.supports.push_back({i, true, true, false});
  }
  return frame;
}

// 10 m x 10 m, in free space.
Frame free_square_frame(double stiffer) {
  Frame frame;
  frame.joints = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  for (int i = 0; i < 4; ++i) frame.members.push_back({i, (i + 1) % 4, square(0.25, stiffer)});
  return frame;
}

struct Published {
  int mode;  // from 1 on
  double frequency_hz;
  double inextensible, extensible;  // how far each model may differ from it, relative
};

template <class MakeFrame>
void expect_published(const MakeFrame& make_frame, const std::vector<Published>& list) {
  const Frame frame = make_frame(1.0), inextensible = make_frame(1e6);
  const Modes found = modes(assemble(frame, 32), list.back().mode);
  const Eigen::VectorXd frequency = found.frequency_hz();
  for (const Published& published : list) {
    const int mode = published.mode;
    // Hermite's cubics err by (b h)^4/1440, 1.7e-6 for the highest modes here.
    EXPECT_NEAR(frequency[mode - 1] / exact_frequency(frame, mode), 1.0, 2e-6) << "mode " << mode;
    EXPECT_NEAR(exact_frequency(inextensible, mode) / published.frequency_hz, 1.0, published.inextensible)
        << "mode " << mode;
    EXPECT_NEAR(frequency[mode - 1] / published.frequency_hz, 1.0, published.extensible) << "mode " << mode;
  }
}

constexpr double digits = 3e-5;  // half a unit of the last published digit of 17.709

// Test 1. In modes 2, 3, 6 and 7 the middle joint moves and the arms stretch.
TEST(NafemsFrames, PinEndedCross) {
  expect_published([](double stiffer) { return pin_ended_cross(4, stiffer); }, {{1, 11.336, digits, digits},
                                                                                {2, 17.709, digits, 2e-3},
                                                                                {3, 17.709, digits, 2e-3},
                                                                                {4, 17.709, digits, digits},
                                                                                {5, 45.345, digits, digits},
                                                                                {6, 57.390, digits, 6e-3},
                                                                                {7, 57.390, digits, 6e-3},
                                                                                {8, 57.390, digits, digits}});
}

// Test 2. Modes 4 to 8 and 12 to 16 are five of the same frequency.
TEST(NafemsFrames, PinEndedDoubleCross) {
  std::vector<Published> list{
      {1, 11.336, digits, digits}, {2, 17.709, digits, 2e-3}, {3, 17.709, digits, 2e-3}};
  for (int mode = 4; mode <= 8; ++mode) list.push_back({mode, 17.709, digits, digits});
  list.insert(list.end(),
              {{9, 45.345, digits, digits}, {10, 57.390, digits, 6e-3}, {11, 57.390, digits, 6e-3}});
  for (int mode = 12; mode <= 16; ++mode) list.push_back({mode, 57.390, digits, digits});
  expect_published([](double stiffer) { return pin_ended_cross(8, stiffer); }, list);
}

// Test 3. The published 3.261, 11.136, 24.570 and 28.695 Hz are not exact for members that do not stretch
// either (3.262, 11.145, 24.613 and 28.776).
TEST(NafemsFrames, FreeSquareFrame) {
  expect_published(free_square_frame, {{4, 3.261, 3e-4, 3e-4},
                                       {5, 5.668, digits, 6e-4},
                                       {6, 11.136, 1e-3, 7e-4},
                                       {7, 11.136, 1e-3, 7e-4},
                                       {8, 12.849, digits, 3e-3},
                                       {9, 24.570, 2e-3, 2e-3},
                                       {10, 28.695, 3e-3, 2e-3},
                                       {11, 28.695, 3e-3, 2e-3}});
  const Modes rigid = modes(assemble(free_square_frame(1.0), 32), 4);
  EXPECT_EQ(rigid.rigid, 3);
  EXPECT_EQ(rigid.angular_frequency.head(3), Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace beamid::fem::nafems_frames_test
