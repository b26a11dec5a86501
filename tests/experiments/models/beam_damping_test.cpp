// Damping of the finite-element beam as an identification model.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fem/structural_system.hpp"
#include "tests/experiments/models/beam_model.hpp"

namespace beamid::experiments::beam_damping_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

TEST(BeamModel, GivesEveryModeItsDampingRatio) {
  // Oracle: -Re lambda / |lambda| of the motion; the ratios described, and the one asked about.
  ModelSetting setting = test::beam_setting(test::steel_beam(0.36), 20, {{Quantity::acceleration, 1.1}});
  test::reduce_by(setting, "modal_truncation", {{"modes", 4.0}});
  setting.damping = fem::ModalDamping{{0.004, 0.01, 0.02}};
  setting.parameters = {test::parameter("bending_stiffness"), test::of_mode("damping_ratio", 2)};
  const auto model = beam_model(setting);
  EXPECT_DOUBLE_EQ(model->unknowns[1].guess, 0.01);
  EXPECT_EQ(model->unknowns[1].name, "damping_ratio_2");
  VectorXd state = state_at_guess(*model);
  set_unknown(*model, state, 0, 1.5 * model->unknowns[0].guess);  // ratios stay what they are
  set_unknown(*model, state, 1, 0.03);
  const auto found = upper_eigenvalues(*model, state);
  const double expected[] = {0.004, 0.03, 0.02, 0.02};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(-found[i].real() / std::abs(found[i]), expected[i], 1e-9);
}

TEST(BeamModel, DampingRatiosHoldToSecondOrderWhereShapesChange) {
  // Oracle: the definition of the ratio; the Rayleigh quotient of the guess's shapes errs by the square of
  // the change.
  ModelSetting setting = test::beam_setting(test::steel_beam(0.36), 20, {{Quantity::displacement, 1.1}});
  test::reduce_by(setting, "krylov", {{"moments", 5.0}});
  setting.parameters = {test::parameter("tip_mass"), test::parameter("damping_ratio")};
  const auto model = beam_model(setting);
  double before = 0.0;
  for (const double change : {0.2, 0.1, 0.05}) {
    VectorXd state = state_at_guess(*model);
    set_unknown(*model, state, 0, (1.0 + change) * model->unknowns[0].guess);
    const auto lambda = upper_eigenvalues(*model, state)[1];
    const double error = std::abs(-lambda.real() / std::abs(lambda) / model->unknowns[1].guess - 1.0);
    EXPECT_LT(error, 0.4 * change * change);
    if (before > 0.0) {
      EXPECT_GT(before / error, 3.0);
    }
    before = error;
  }
}

TEST(BeamModel, DampingRatiosHoldWhereExactModesFollow) {
  // Oracle: the definition of the ratio.
  ModelSetting setting = test::beam_setting(test::steel_beam(0.36), 20, {{Quantity::displacement, 1.1}});
  test::reduce_by(setting, "modal_truncation", {{"modes", 5.0}});
  setting.parameters = {test::parameter("tip_mass"), test::parameter("damping_ratio")};
  const auto model = beam_model(setting);
  VectorXd state = state_at_guess(*model);
  set_unknown(*model, state, 0, 1.2 * model->unknowns[0].guess);
  for (const auto& lambda : upper_eigenvalues(*model, state))
    EXPECT_NEAR(-lambda.real() / std::abs(lambda) / model->unknowns[1].guess, 1.0, 1e-9);
}

TEST(BeamModel, KeepsRayleighsDampingWhereNoRatioIsAsked) {
  // Oracle: fem::damping_ratios of the law at the modes' frequencies.
  ModelSetting setting = test::beam_setting(test::steel_beam(0.36), 20, {{Quantity::displacement, 1.1}});
  test::reduce_by(setting, "modal_truncation", {{"modes", 3.0}});
  setting.damping = fem::RayleighDamping{{3.0, 0.01}, {60.0, 0.02}};
  for (const std::string asked : {"mass_damping", "damping_ratio"}) {
    setting.parameters = {test::parameter(asked)};
    const auto model = beam_model(setting);
    VectorXd state = state_at_guess(*model);
    if (asked == "damping_ratio") set_unknown(*model, state, 0, 0.015);
    const auto found = upper_eigenvalues(*model, state);
    const VectorXd ratios = fem::damping_ratios(setting.damping, model->mode_frequencies);
    for (Index i = 0; i < 3; ++i) {
      const auto lambda = found[static_cast<std::size_t>(i)];
      EXPECT_NEAR(-lambda.real() / std::abs(lambda), asked == "damping_ratio" ? 0.015 : ratios[i], 1e-10);
    }
  }
}

}  // namespace
}  // namespace beamid::experiments::beam_damping_test
