// Modes of a record: what is neither reached nor seen is none; the one shown is the nearest that is strong.
#include "experiments/identify/engine/run_bound.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

namespace beamid::experiments::run_mode_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Two oscillators side by side, of 1 and 3 rad/s and 1 %; k_2 is unknown.
class Two final : public filters::LinearMotion {
 public:
  Two(double first_reached, double first_seen, bool forced)
      : reached_(first_reached), seen_(first_seen), forced_(forced) {}
  Index input_size() const override { return forced_ ? 1 : 0; }
  Index motion_size() const override { return 4; }
  Index parameter_size() const override { return 1; }
  std::vector<filters::Label> state_labels() const override { return std::vector<filters::Label>(5); }
  std::vector<filters::Label> output_labels() const override { return std::vector<filters::Label>(1); }
  void motion_matrix(const VectorXd& z, MatrixXd& a) const override {
    a.setZero(4, 4);
    a.topRightCorner(2, 2).setIdentity();
    a.bottomRows(2) << -1.0, 0.0, -0.02, 0.0, 0.0, -z[4], 0.0, -0.06;
  }
  void motion_matrix_derivative(const VectorXd&, Index, MatrixXd& a) const override {
    a.setZero(4, 4);
    a(3, 1) = -1.0;
  }
  void input_matrix(const VectorXd&, MatrixXd& b) const override {
    b = forced_ ? MatrixXd(Eigen::Vector4d(0.0, 0.0, reached_, 1.0)) : MatrixXd(4, 0);
  }
  void output(const VectorXd& z, const VectorXd&, VectorXd& y) const override {
    y = VectorXd::Constant(1, seen_ * z[0] + z[1]);
  }

 private:
  double reached_, seen_;
  bool forced_;
};

std::optional<RecordedModes> modes_of(const Two& motion, std::optional<double> record_hz) {
  JointModel model;
  model.motion = std::make_shared<Two>(motion);
  model.unknown_places = {4};
  VectorXd state = VectorXd::Zero(5);
  state[4] = 9.0;
  return recorded_modes(model, state, {VectorXd::Constant(1, 9.0), MatrixXd::Constant(1, 1, 0.01), {}},
                        record_hz);
}

double frequency_of(const Two& motion) {
  const auto found = modes_of(motion, {});
  return found ? 2.0 * std::numbers::pi * found->lowest.frequency_hz : 0.0;
}

TEST(LowestMode, IsTheSlowestWhereTheRecordHoldsIt) {
  EXPECT_NEAR(frequency_of(Two(1.0, 1.0, true)), 1.0, 1e-12);
  EXPECT_NEAR(frequency_of(Two(0.0, 1.0, false)), 1.0, 1e-12);
}

TEST(LowestMode, IsNoneThatTheInputsDoNotReach) {
  EXPECT_NEAR(frequency_of(Two(0.0, 1.0, true)), 3.0, 1e-12);
}

TEST(LowestMode, IsNoneThatNoSensorSees) {
  EXPECT_NEAR(frequency_of(Two(1.0, 0.0, true)), 3.0, 1e-12);
  EXPECT_NEAR(frequency_of(Two(1.0, 0.0, false)), 3.0, 1e-12);
}

// d(omega / 2 pi) / dk = 1 / (4 pi omega), of a deviation of 0.1.
TEST(ShownMode, IsTheNearestToTheRecordsWithADeviationOfItsOwn) {
  constexpr double hz = 1.0 / (2.0 * std::numbers::pi);
  const auto second = modes_of(Two(1.0, 1.0, true), 2.8 * hz);
  ASSERT_TRUE(second);
  EXPECT_NEAR(second->lowest.frequency_hz, hz, 1e-12);
  EXPECT_NEAR(second->shown.frequency_hz, 3.0 * hz, 1e-12);
  EXPECT_NEAR(second->shown.frequency_deviation_hz, 0.1 * hz / 6.0, 1e-5);
  const auto first = modes_of(Two(1.0, 1.0, true), 1.3 * hz);
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->shown.frequency_hz, hz, 1e-12);
  EXPECT_NEAR(first->shown.frequency_deviation_hz, 0.0, 1e-12);
}

TEST(ShownMode, IsNoneThatIsHardlyInTheRecord) {
  const auto modes = modes_of(Two(1000.0, 1.0, true), 3.0 / (2.0 * std::numbers::pi));
  ASSERT_TRUE(modes);
  EXPECT_NEAR(modes->shown.frequency_hz, modes->lowest.frequency_hz, 1e-12);
}

}  // namespace
}  // namespace beamid::experiments::run_mode_test
