// Oracle: the equation of motion, M a + C v + K x = 0, written out here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/joint_model.hpp"
#include "fem/assembly.hpp"
#include "tests/experiments/models/one_coordinate.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::experiments {
namespace {

using Eigen::VectorXd;

std::unique_ptr<JointModel> sdof(const std::vector<Quantity>& observed, const filters::Options& options = {},
                                 const fem::StructuralSystem& system = test::one_coordinate(3.0, 515.8)) {
  return model_registry().make("sdof", options, at_one_point(system, observed));
}

std::string refusal(const std::vector<Quantity>& observed, const fem::StructuralSystem& system) {
  try {
    sdof(observed, {}, system);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing was thrown";
}

VectorXd output_of(const JointModel& model, const VectorXd& state) {
  VectorXd output;
  model.motion->output(state, {}, output);
  return output;
}

TEST(Sdof, MovesByItsEquationOfMotion) {
  const auto model = sdof({Quantity::displacement});
  VectorXd state(4), rate;
  state << 0.012, -0.3, 515.8, 8.0;
  model->motion->rate(state, {}, rate);
  EXPECT_EQ(rate[0], -0.3);
  EXPECT_NEAR(3.0 * rate[1] + 8.0 * -0.3 + 515.8 * 0.012, 0.0, 1e-14);
}

TEST(Sdof, ReadsAccelerationWithTheSensorsBias) {
  const auto model = sdof({Quantity::velocity, Quantity::acceleration, Quantity::displacement});
  VectorXd state(5);
  state << 0.012, -0.3, 515.8, 8.0, 0.25;
  const VectorXd output = output_of(*model, state);
  EXPECT_EQ(output[0], -0.3);
  EXPECT_NEAR(3.0 * (output[1] - 0.25) + 8.0 * -0.3 + 515.8 * 0.012, 0.0, 1e-14);
  EXPECT_EQ(output[2], 0.012);
}

TEST(Sdof, EstimatesABiasOnlyWhereThereIsASensorOfAcceleration) {
  const filters::Options without{{"sensor_bias", false}};
  EXPECT_EQ(sdof({Quantity::acceleration})->offsets.size(), 1u);
  EXPECT_EQ(sdof({Quantity::acceleration}, without)->offsets.size(), 0u);
  EXPECT_EQ(sdof({Quantity::displacement, Quantity::velocity})->offsets.size(), 0u);
  VectorXd state(4);
  state << 0.012, -0.3, 515.8, 8.0;
  EXPECT_NEAR(output_of(*sdof({Quantity::acceleration}, without), state)[0],
              -(515.8 * 0.012 + 8.0 * -0.3) / 3.0, 1e-15);
}

TEST(Sdof, RefusesWhatItCannotDo) {
  const auto system = test::one_coordinate(3.0, 515.8);
  EXPECT_THAT(refusal({Quantity::acceleration, Quantity::force}, system), testing::HasSubstr("found force"));
  EXPECT_THAT(refusal({}, system), testing::HasSubstr("at least one observed quantity"));
  EXPECT_THAT(refusal({Quantity::velocity}, fem::assemble(test::steel_beam(0.36049), 4)),
              testing::AllOf(testing::HasSubstr("one coordinate"), testing::HasSubstr("keeps 8")));
}

}  // namespace
}  // namespace beamid::experiments
