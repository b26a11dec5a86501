// Oracle: the information about the whole state, the dense matrix of filters::fisher_information(), inverted.
#include "experiments/identify/bounds/identifiability.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "filters/discrete_model.hpp"
#include "filters/fisher_information.hpp"
#include "tests/experiments/identify/bounds/oscillator.hpp"
#include "tests/experiments/models/one_coordinate.hpp"

namespace beamid::experiments::channel_information_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double dt = 2e-3, noise = 0.05;

ObservedMotion decay_of_a_mode(const std::vector<Quantity>& observed) {
  ModelSetting setting = at_one_point(beamid::test::one_coordinate(3.0, 515.8), observed);
  setting.damping = fem::ModalDamping{{0.004}};
  ObservedMotion motion;
  motion.model = *model_registry().make("sdof", {}, setting);
  motion.interval = dt;
  motion.directions = start_directions(motion.model, setting.observations, {0.012, 6.0});
  motion.initial_state = VectorXd::Zero(static_cast<Index>(motion.model.motion->state_labels().size()));
  motion.initial_state.head<4>() << 0.012, 0.05, motion.model.unknowns[0].guess,
      motion.model.unknowns[1].guess;
  return motion;
}

// Deviations of K and C when the whole state is unknown.
VectorXd dense_bounds(const ObservedMotion& motion, Index samples, const VectorXd& deviations) {
  const auto discrete = filters::discretise(motion.model.motion, motion.interval, "exponential",
                                            {{}, MatrixXd(deviations.cwiseAbs2().asDiagonal())});
  return filters::cramer_rao_bound(filters::fisher_information(*discrete, motion.initial_state, samples))
      .segment<2>(2);
}

void expect_equal(const VectorXd& relative, const ObservedMotion& motion, const VectorXd& expected) {
  for (Index j = 0; j < 2; ++j)
    EXPECT_NEAR(relative[j] * motion.initial_state[2 + j] / expected[j], 1.0, 1e-7) << j;
}

TEST(ChannelInformation, GivesTheBoundsOfTheWholeStateWithTheSensorsBias) {
  const auto motion = decay_of_a_mode({Quantity::acceleration});
  ASSERT_EQ(motion.model.offsets.size(), 1u);
  const auto records = channel_information(motion, {{700, 1}, {3000, 1}});
  expect_equal(relative_bounds(information_about_unknowns(motion, records[0], {{0, noise}})), motion,
               dense_bounds(motion, 700, VectorXd::Constant(1, noise)));
  expect_equal(relative_bounds(information_about_unknowns(motion, records[1], {{0, noise}})), motion,
               dense_bounds(motion, 3000, VectorXd::Constant(1, noise)));
}

TEST(ChannelInformation, OfSeveralSensorsAddsUp) {
  const auto motion = decay_of_a_mode({Quantity::displacement, Quantity::acceleration});
  const Eigen::Vector2d deviations(2e-5, noise);
  const auto record = channel_information(motion, {{2000, 1}}).front();
  expect_equal(
      relative_bounds(information_about_unknowns(motion, record, {{0, deviations[0]}, {1, deviations[1]}})),
      motion, dense_bounds(motion, 2000, deviations));
}

TEST(ChannelInformation, OfEveryTenthSampleIsThatOfATenthOfTheRate) {
  auto motion = decay_of_a_mode({Quantity::acceleration});
  const auto tenth = channel_information(motion, {{3000, 10}}).front();
  const VectorXd found = relative_bounds(information_about_unknowns(motion, tenth, {{0, noise}}));
  motion.interval = 10.0 * dt;
  const auto slow = channel_information(motion, {{300, 1}}).front();
  const VectorXd expected = relative_bounds(information_about_unknowns(motion, slow, {{0, noise}}));
  EXPECT_NEAR(found[0] / expected[0], 1.0, 1e-9);
  EXPECT_NEAR(found[1] / expected[1], 1.0, 1e-9);
}

TEST(ChannelInformation, RefusesReadingsThatCannotBe) {
  auto motion = decay_of_a_mode({Quantity::acceleration});
  EXPECT_THROW(channel_information(motion, {{0, 1}}), std::invalid_argument);
  EXPECT_THROW(channel_information(motion, {{10, 0}}), std::invalid_argument);
  motion.inputs = MatrixXd::Zero(1, 5);
  EXPECT_THROW(channel_information(motion, {{10, 1}}), std::invalid_argument);
}

TEST(InformationAboutUnknowns, RefusesASensorWithoutNoise) {
  const auto motion = decay_of_a_mode({Quantity::acceleration});
  const auto record = channel_information(motion, {{100, 1}}).front();
  EXPECT_THROW(information_about_unknowns(motion, record, {{0, 0.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::channel_information_test
