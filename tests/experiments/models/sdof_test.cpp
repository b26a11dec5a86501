// Oracle: the equation of motion, M a + C v + K x = 0, written out here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/models/joint_model.hpp"
#include "fem/assembly.hpp"
#include "tests/experiments/models/one_coordinate.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::experiments::sdof_test {
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

TEST(Sdof, AsksAboutItsMassWhereAForceWasMeasured) {
  // Oracle: M v' = e f - K x - C v at the output y = r q, where M is M_q / r^2 and the force e f acts by e /
  // r.
  ModelSetting setting =
      at_one_point(test::one_coordinate(3.0, 515.8, 0.5), {Quantity::acceleration, Quantity::displacement});
  setting.forces = {0};
  const auto model = model_registry().make("sdof", {}, setting);
  const auto labels = model->motion->state_labels();
  ASSERT_EQ(labels.size(), 6u);
  EXPECT_EQ(labels[4].name + " " + labels[4].unit, "mass kg");
  ASSERT_EQ(model->unknowns.size(), 3u);
  EXPECT_DOUBLE_EQ(model->unknowns[2].guess, 12.0);
  EXPECT_DOUBLE_EQ(model->unknowns[2].deviation, 1.2);
  VectorXd state(6), rate, output;
  state << 0.012, -0.3, 500.0, 8.0, 11.0, 0.25;
  const VectorXd force = VectorXd::Constant(1, 4.0);
  model->motion->rate(state, force, rate);
  EXPECT_NEAR(11.0 * rate[1] + 8.0 * -0.3 + 500.0 * 0.012 - 4.0 / 0.5, 0.0, 1e-13);
  model->motion->output(state, force, output);
  EXPECT_NEAR(output[0], rate[1] + 0.25, 1e-14);
  EXPECT_EQ(output[1], 0.012);
}

TEST(Sdof, LearnsNothingOfItsMassFromAMovingBase) {
  // Oracle: relative motion x'' = -L a_base / M - ..., whatever M is, and an absolute accelerometer.
  fem::StructuralSystem system = test::one_coordinate(3.0, 515.8);
  system.input_names = {"base_acceleration"};
  system.inputs.coeffRef(0, 0) = -3.0;  // rigid with the base: L = M
  ModelSetting setting = at_one_point(system, {Quantity::acceleration});
  setting.forces = {0};
  const auto model = model_registry().make("sdof", {{"sensor_bias", false}}, setting);
  EXPECT_EQ(model->unknowns.size(), 2u);
  VectorXd state(4), rate, output;
  state << 0.0, 0.0, 515.8, 8.0;
  const VectorXd base = VectorXd::Constant(1, 2.0);
  model->motion->rate(state, base, rate);
  EXPECT_NEAR(rate[1], -2.0, 1e-15);
  model->motion->output(state, base, output);
  EXPECT_NEAR(output[0], 0.0, 1e-15);
}

TEST(Sdof, TakesOtherEstimatesFromParameters) {
  ModelSetting setting = at_one_point(test::one_coordinate(3.0, 515.8), {Quantity::displacement});
  setting.parameters.resize(1);
  setting.parameters[0].quantity = "stiffness";
  setting.parameters[0].guess = 600.0;
  setting.parameters[0].relative_deviation = 0.1;
  const auto model = model_registry().make("sdof", {}, setting);
  EXPECT_EQ(model->unknowns[0].guess, 600.0);
  EXPECT_DOUBLE_EQ(model->unknowns[0].deviation, 60.0);
  EXPECT_NEAR(model->unknowns[1].guess, 2.0 * 0.01 * std::sqrt(515.8 * 3.0), 1e-12);
  setting.parameters[0].quantity = "mass";  // no force was measured
  EXPECT_THROW(model_registry().make("sdof", {}, setting), std::invalid_argument);
  setting.parameters[0].quantity = "stiffness";
  setting.parameters[0].form = Form::logarithmic;
  EXPECT_THROW(model_registry().make("sdof", {}, setting), std::invalid_argument);
}

TEST(Sdof, RefusesWhatItCannotDo) {
  const auto system = test::one_coordinate(3.0, 515.8);
  EXPECT_THAT(refusal({Quantity::acceleration, Quantity::force}, system), testing::HasSubstr("found force"));
  EXPECT_THAT(refusal({}, system), testing::HasSubstr("at least one observed quantity"));
  EXPECT_THAT(refusal({Quantity::velocity}, fem::assemble(test::steel_beam(0.36049), 4)),
              testing::AllOf(testing::HasSubstr("one coordinate"), testing::HasSubstr("keeps 8")));
}

}  // namespace
}  // namespace beamid::experiments::sdof_test
