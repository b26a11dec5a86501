// Parts of a structure between supports whose motion is imposed.
#include "experiments/models/motion/supported_motion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "experiments/models/joint_model.hpp"
#include "experiments/models/structure_points.hpp"
#include "fem/shear_building.hpp"
#include "filters/central_differences.hpp"

namespace beamid::experiments::supported_motion_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

const fem::Structure building = fem::shear_building({{1000, 900, 1100, 800, 950, 700},
                                                     {2.0e6, 1.8e6, 1.6e6, 1.5e6, 1.2e6, 1.0e6},
                                                     {2000, 1900, 1700, 1500, 1300, 1000},
                                                     {}});

// Floors 3 and 4 between the measured floors 2 and 5, a force at floor 4.
ModelSetting part_setting(std::vector<ParameterChoice> asked) {
  StructurePoints points(building);
  ModelSetting setting;
  const Index third = points.add(3.0), fourth = points.add(4.0), second = points.add(2.0),
              fifth = points.add(5.0);
  setting.system = fem::assemble(building, 6, points.all());
  const MatrixXd rows = MatrixXd(setting.system.outputs);
  MatrixXd outputs(2, rows.cols());
  outputs << rows.row(third), rows.row(fourth);
  setting.system.outputs = outputs.sparseView();
  setting.observations = {{Quantity::acceleration, "a3"}, {Quantity::acceleration, "a4"}};
  setting.forces = {fourth, second, fifth};
  setting.supports = {1, 2};
  setting.parameters = std::move(asked);
  setting.continuum = ModelSetting::Continuum{building, 6, points.all()};
  return setting;
}

std::vector<ParameterChoice> storeys() {
  std::vector<ParameterChoice> asked;
  for (const double top : {3.0, 4.0, 5.0}) {
    asked.push_back({"storey_stiffness", "", std::pair{top - 1.0, top}});
    asked.push_back({"storey_damping", "", std::pair{top - 1.0, top}});
  }
  for (ParameterChoice& choice : asked) choice.form = Form::linear;
  return asked;
}

std::unique_ptr<JointModel> part(std::vector<ParameterChoice> asked) {
  return model_registry().make("beam", {{"sensor_bias", false}}, part_setting(std::move(asked)));
}

TEST(SupportedMotion, AcceleratesAsTheWholeBuildingDoes) {
  // Oracle: M a = f - C v - K x of all six floors, whatever their motion.
  const auto model = part(storeys());
  const fem::StructuralSystem whole = fem::assemble(building, 6);
  const VectorXd x = VectorXd::Random(6) * 1e-3, v = VectorXd::Random(6) * 0.1;
  VectorXd force = VectorXd::Zero(6);
  force[3] = 300.0;
  const VectorXd a =
      MatrixXd(whole.mass).ldlt().solve(force - whole.damping * v - whole.stiffness.assembled() * x);
  VectorXd state(8 + 6), seen;
  state << x[2], x[3], x[1], x[4], v[2], v[3], v[1], v[4], VectorXd::Zero(6);
  for (std::size_t j = 0; j < 6; ++j) state[model->unknown_places[j]] = model->unknowns[j].guess;
  VectorXd input(3), rate;
  input << force[3], a[1], a[4];
  model->motion->output(state, input, seen);
  EXPECT_NEAR(seen[0], a[2], 1e-10 * a.norm());
  EXPECT_NEAR(seen[1], a[3], 1e-10 * a.norm());
  model->motion->rate(state, input, rate);
  EXPECT_NEAR(rate[6], a[1], 1e-12);
  EXPECT_NEAR(rate[7], a[4], 1e-12);
}

TEST(SupportedMotion, HasTheDerivativesOfItsRate) {
  // Oracle: central differences.
  const auto model = part(storeys());
  VectorXd state(14), input(3);
  state << 1e-3, -2e-3, 0.5e-3, 2e-3, 0.1, -0.2, 0.05, 0.3, VectorXd::Zero(6);
  for (std::size_t j = 0; j < 6; ++j) state[model->unknown_places[j]] = 1.1 * model->unknowns[j].guess;
  input << 100.0, 0.5, -0.7;
  MatrixXd exact, difference;
  model->motion->rate_jacobian(state, input, exact);
  filters::central_differences(
      [&](const VectorXd& at, VectorXd& value) { model->motion->rate(at, input, value); }, state, 14,
      difference);
  EXPECT_LT((exact - difference).cwiseAbs().maxCoeff(), 1e-5 * exact.cwiseAbs().maxCoeff());
}

TEST(SupportedMotion, LeavesOutWhatLiesBeyondItsSupports) {
  ModelSetting setting = part_setting({{"storey_stiffness", "", std::pair{2.0, 3.0}}});
  const auto model = model_registry().make("beam", {{"sensor_bias", false}}, setting);
  EXPECT_EQ(model->motion_size(), 4);  // floors 3 and 4, and the supports 2 and 5
}

TEST(SupportedMotion, NeedsASensorBetweenItsSupports) {
  ModelSetting setting = part_setting({{"storey_stiffness", "", std::pair{2.0, 3.0}}});
  const MatrixXd at_support = MatrixXd(setting.system.inputs).col(setting.forces[1]).transpose();
  setting.system.outputs = at_support.replicate(2, 1).sparseView();
  try {
    model_registry().make("beam", {{"sensor_bias", false}}, setting);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("expected one at a place between the supports"));
  }
}

TEST(SupportedMotion, IsOfModelBeamAlone) {
  for (const char* const name : {"sdof", "modal", "duffing"})
    EXPECT_THROW(model_registry().make(name, model_registry().completed(name, {}), part_setting({})),
                 std::invalid_argument)
        << name;
}

}  // namespace
}  // namespace beamid::experiments::supported_motion_test
