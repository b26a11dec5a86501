// The motion on a spring with or without Masing's loop. Oracles: central differences, the loop's closed-form
// energy.
#include "experiments/identify/backbone/loop_motion.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

namespace beamid::experiments::loop_motion_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

LoopMotionSetting softening() {
  LoopMotionSetting setting;
  setting.spring = SecantCurve(0.033, 7), setting.damping = SecantCurve(0.033, 3);
  setting.mass = 1.08, setting.omega = 15, setting.interval = 0.02, setting.steps = 3;
  setting.observed = Quantity::acceleration, setting.hysteretic = true;
  return setting;
}

VectorXd begin(const LoopMotion& motion, double velocity, double masing) {
  VectorXd state = VectorXd::Zero(motion.states());
  state[0] = 0.02, state[1] = velocity;
  state.segment(5, 7) << 480, 420, 350, 280, 230, 180, 140;
  state.segment(12, 3) << 0.3, 0.5, 0.4;
  state[motion.masing()] = masing;
  return state;
}

VectorXd after(LoopMotion& motion, VectorXd state, int intervals) {
  VectorXd next;
  for (int i = 0; i < intervals; ++i) motion.transition(state, {}, next), state.swap(next);
  return state;
}

TEST(LoopMotion, ItsTangentsThroughReversalsAreThoseOfDifferences) {
  LoopMotion motion(softening());
  for (const double masing : {0.0, 0.5, 1.0})
    for (const double velocity : {-0.05, 0.003, -0.4}) {
      const VectorXd start = begin(motion, velocity, masing);
      MatrixXd directions = MatrixXd::Identity(motion.states(), motion.states());
      VectorXd state = start, next;
      for (int i = 0; i < 40; ++i) motion.move(state, {}, next, directions), state.swap(next);
      for (Index i = 0; i < start.size(); ++i) {
        if (i == LoopMotion::begun) continue;
        const double step = i < 2 ? 1e-8 : std::max(1e-6, 1e-6 * std::abs(start[i]));
        VectorXd up = start, down = start;
        up[i] += step, down[i] -= step;
        const VectorXd slope = (after(motion, up, 40) - after(motion, down, 40)) / (2 * step);
        for (const Index row : {LoopMotion::displacement, LoopMotion::velocity})
          EXPECT_NEAR(directions(row, i), slope[row], 1e-4 * directions.row(row).norm())
              << masing << " " << velocity << " " << i;
      }
    }
}

TEST(LoopMotion, ItsOutputHasTheSlopesOfDifferences) {
  LoopMotion motion(softening());
  const VectorXd start = begin(motion, -0.2, 0.7);
  MatrixXd slopes;
  motion.output_jacobian(start, {}, slopes);
  for (Index i = 0; i < start.size(); ++i) {
    if (i == LoopMotion::begun) continue;
    VectorXd up = start, down = start, high, low;
    const double step = 1e-7 * std::max(1.0, std::abs(start[i]));
    up[i] += step, down[i] -= step;
    motion.output(up, {}, high), motion.output(down, {}, low);
    EXPECT_NEAR(slopes(0, i), (high[0] - low[0]) / (2 * step), 1e-6 * slopes.norm()) << i;
  }
}

// From rest to rest the kinetic energy is zero at both ends, so what the branch takes is the work of its
// force: int H dx over the half swing = 0 without viscous damping.
TEST(LoopMotion, TheWorkOfABranchBetweenReversalsIsZero) {
  LoopMotionSetting setting = softening();
  setting.steps = 40;
  LoopMotion motion(setting);
  VectorXd state = begin(motion, 0, 1);
  state.segment(12, 3).setZero();
  VectorXd next;
  std::vector<double> reversals{state[0]};
  for (int i = 0; i < 200; ++i) {
    motion.transition(state, {}, next), state.swap(next);
    if (state[LoopMotion::reversal] != reversals.back()) reversals.push_back(state[LoopMotion::reversal]);
  }
  ASSERT_GT(reversals.size(), 6u);
  const VectorXd theta = state.segment(5, 7);
  const auto force = [&](double x) { return x * setting.spring.shape(x).dot(theta); };
  double at_reversal = force(reversals[0]);
  const double energy = force(reversals[0]) * reversals[0];
  for (std::size_t k = 0; k + 1 < 6; ++k) {
    const double from = reversals[k], to = reversals[k + 1];
    const auto branch = [&](double x) { return at_reversal + 2 * force(0.5 * (x - from)); };
    constexpr int points = 2000;
    double work = 0;
    for (int i = 0; i < points; ++i)
      work += branch(from + (to - from) * (i + 0.5) / points) * (to - from) / points;
    EXPECT_NEAR(work / energy, 0, 1e-5) << k;
    at_reversal = branch(to);
  }
}

}  // namespace
}  // namespace beamid::experiments::loop_motion_test
