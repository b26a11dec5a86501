// The finite-element beam as an identification model.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fem/exact/exact_cantilever.hpp"
#include "fem/modes.hpp"
#include "filters/filter_run.hpp"
#include "tests/experiments/models/beam_model.hpp"

namespace beamid::experiments::beam_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

TEST(BeamModel, HasTheFrequenciesOfTheBeamWithOtherParameters) {
  // Oracle: the beam with these values, assembled and solved anew. Without a reduction nothing is
  // approximate.
  fem::Cantilever steel = test::steel_beam(0.36);
  ModelSetting setting = test::beam_setting(steel, 8, {{Quantity::displacement, 1.1}});
  setting.parameters = {test::parameter("bending_stiffness"), test::parameter("tip_mass")};
  const auto model = beam_model(setting);
  VectorXd state = state_at_guess(*model);
  set_unknown(*model, state, 0, 1.3 * steel.bending_stiffness);
  set_unknown(*model, state, 1, 0.1);
  steel.bending_stiffness *= 1.3;
  steel.tip_mass = 0.1;
  const VectorXd expected = fem::modes(fem::assemble(steel, 8), 5).angular_frequency;
  const auto found = upper_eigenvalues(*model, state);
  for (Index i = 0; i < 5; ++i)
    EXPECT_NEAR(found[static_cast<std::size_t>(i)].imag(), expected[i], 1e-8 * expected[i]);
}

TEST(BeamModel, FollowsTheExactFrequencyThroughAFewModes) {
  // Oracle: the exact cantilever with a tip mass 20 % off that of the guess. Shapes of the guess make the
  // error of second order: two of them, by their deflections and more, leave 1e-6; exact modes follow.
  fem::Cantilever steel = test::steel_beam(1.338090);
  const ModelSetting plain = test::beam_setting(steel, 40, {{Quantity::displacement, 1.1}});
  const double assumed = steel.tip_mass;
  steel.tip_mass *= 1.2;
  const double exact = fem::ExactMode(steel, 1).angular_frequency();
  const auto error_of = [&](const std::string& reduction, const filters::Options& options) {
    ModelSetting setting = plain;
    test::reduce_by(setting, reduction, options);
    setting.parameters = {test::parameter("tip_mass")};
    const auto model = beam_model(setting);
    VectorXd state = state_at_guess(*model);
    set_unknown(*model, state, 0, 1.2 * assumed);
    return std::abs(upper_eigenvalues(*model, state)[0].imag() / exact - 1.0);
  };
  EXPECT_LT(error_of("modal_truncation", {{"modes", 3.0}, {"static_correction", true}}), 2e-6);
  EXPECT_LT(error_of("modal_truncation", {{"modes", 3.0}}), 1e-8);
  EXPECT_LT(error_of("serep", {{"masters_m", std::vector<double>{0.5, 0.8, 1.1}}}), 1e-8);
}

TEST(BeamModel, FindsStiffnessAndDampingOfASimulatedBeam) {
  // Oracle: the values the record was made with, by the filter that is exact on this model; no noise.
  ModelSetting setting = test::beam_setting(test::steel_beam(0.36), 20,
                                            {{Quantity::acceleration, 1.1}, {Quantity::strain, 0.0}});
  test::reduce_by(setting, "modal_truncation", {{"modes", 2.0}});
  const auto model = beam_model(setting);
  const double dt = 1e-3, stiffness = 1.1 * model->unknowns[0].guess, ratio = 0.7 * model->unknowns[1].guess;
  const MatrixXd noise = VectorXd(Eigen::Vector2d(1e-4, 1e-14)).asDiagonal();
  const auto step = filters::discretise(model->motion, dt, "exponential", {{}, noise});
  VectorXd truth = state_at_guess(*model), next;
  truth[0] = 0.012;
  truth[1] = 1e-4;
  set_unknown(*model, truth, 0, stiffness);
  set_unknown(*model, truth, 1, ratio);
  filters::Measurements record{VectorXd::LinSpaced(3000, 0.0, 2.999), MatrixXd(2, 3000), {}};
  for (Index k = 0; k < 3000; ++k) {
    VectorXd output;
    step->output(truth, {}, output);
    record.outputs.col(k) = output;
    step->transition(truth, {}, next);
    truth = next;
  }
  filters::Gaussian start{state_at_guess(*model), {}};
  VectorXd deviations = VectorXd::Constant(start.mean.size(), 0.1);
  deviations.head(2) << 0.02, 0.002;
  for (std::size_t j = 0; j < 2; ++j) deviations[model->unknown_places[j]] = model->unknowns[j].deviation;
  start.covariance = deviations.cwiseAbs2().asDiagonal();
  const auto filter = filters::filter_registry().make(
      "ekf", {}, filters::discretise(model->motion, dt, "exponential", {{}, noise}));
  for (int pass = 0; pass < 3; ++pass) {
    const filters::FilterRun run = filters::run(*filter, start, record);
    ASSERT_FALSE(run.failure) << run.failure->reason;
    start.mean.tail(3) = run.last.mean.tail(3);
  }
  EXPECT_NEAR(start.mean[model->unknown_places[0]], stiffness, 1e-5 * stiffness);
  EXPECT_NEAR(start.mean[model->unknown_places[1]], ratio, 1e-3 * ratio);
}

std::string refusal(const ModelSetting& setting, const filters::Options& options = {}) {
  try {
    beam_model(setting, options);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(BeamModel, SaysWhatItCannotDo) {
  ModelSetting setting = test::beam_setting(test::steel_beam(0.36), 10, {{Quantity::acceleration, 1.1}});
  const auto asking = [&](std::vector<ParameterChoice> parameters) {
    ModelSetting asked = setting;
    asked.parameters = std::move(parameters);
    return refusal(asked);
  };
  EXPECT_THAT(asking({test::parameter("root_rotational_stiffness")}), testing::HasSubstr("no elastic root"));
  EXPECT_THAT(asking({test::parameter("tip_rotary_inertia")}),
              testing::AllOf(testing::HasSubstr("guessed as 0"), testing::HasSubstr("deviation_kg_m2")));
  EXPECT_THAT(asking({test::parameter("frequency")}), testing::HasSubstr("has no parameter 'frequency'"));
  EXPECT_THAT(asking({test::in_region(0.2, 0.5), test::in_region(0.4, 0.6)}),
              testing::HasSubstr("regions overlap"));
  EXPECT_THAT(asking({test::parameter("tip_mass"), test::parameter("tip_mass")}),
              testing::HasSubstr("requested twice"));
  EXPECT_THAT(asking({test::of_mode("damping_ratio", 400)}), testing::HasSubstr("mode 400"));
  EXPECT_THAT(refusal(setting, {{"sensor_bias", false}, {"sensor_drift", true}}),
              testing::HasSubstr("sensor_drift"));
  ModelSetting bare = setting;
  bare.continuum.reset();
  EXPECT_THAT(refusal(bare), testing::HasSubstr("the beam itself"));
  fem::Beam cubic = test::steel_beam(0.36);
  cubic.springs = {{1.1, 0.0, 0.0, 1e6}};
  EXPECT_THAT(refusal(test::beam_setting(cubic, 10, {{Quantity::acceleration, 1.1}})),
              testing::HasSubstr("is linear; found 1"));
}

TEST(BeamModel, CountsRegionsAndTakesGivenNames) {
  ModelSetting setting = test::beam_setting(test::steel_beam(0.36), 10, {{Quantity::acceleration, 1.1}});
  setting.parameters = {test::in_region(0.0, 0.4), test::in_region(0.4, 0.7), test::in_region(0.7, 1.1)};
  setting.parameters[1].name = "crack";
  setting.parameters[2].known = true;
  test::reduce_by(setting, "modal_truncation", {{"modes", 3.0}});
  const auto model = beam_model(setting);
  EXPECT_EQ(model->unknowns[0].name, "bending_stiffness_1");
  EXPECT_EQ(model->unknowns[1].name, "crack");
  EXPECT_EQ(model->unknowns[2].name, "bending_stiffness_2");
  EXPECT_TRUE(model->unknowns[2].nuisance);
  EXPECT_NEAR(model->unknowns[1].deviation, 0.3 * model->unknowns[1].guess, 1e-12);
}

}  // namespace
}  // namespace beamid::experiments::beam_test
