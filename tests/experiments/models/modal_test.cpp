// Modes with unknown frequencies and ratios.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/experiments/models/beam_setting.hpp"

namespace beamid::experiments::modal_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using std::numbers::pi;

ModelSetting setting_of(const std::vector<test::SensorAt>& sensors, const std::vector<double>& forces = {}) {
  ModelSetting setting = test::beam_setting(test::steel_beam(0.0198575), 40, sensors, forces);
  test::reduce_by(setting, "modal_truncation", {{"modes", 3.0}});
  setting.damping = fem::ModalDamping{{0.002, 0.005}};
  return setting;
}

VectorXd at_guess(const JointModel& model) {
  VectorXd state = VectorXd::Zero(static_cast<Index>(model.motion->state_labels().size()));
  for (std::size_t j = 0; j < model.unknowns.size(); ++j)
    state[model.unknown_places[j]] = model.unknowns[j].guess;
  return state;
}

std::string refusal(const ModelSetting& setting, const filters::Options& options = {}) {
  try {
    model_registry().make("modal", options, setting);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(ModalModel, GuessesTheModesOfTheBeam) {
  // Oracle: the exact first frequency of S(0.65); the law's ratios.
  const auto model = model_registry().make("modal", {}, setting_of({{Quantity::acceleration, 1.1}}));
  ASSERT_EQ(model->unknowns.size(), 6u);
  EXPECT_EQ(model->unknowns[0].name, "frequency_1");
  EXPECT_EQ(model->unknowns[0].unit, "Hz");
  EXPECT_NEAR(model->unknowns[0].guess, 4.145510989755, 1e-6);
  EXPECT_NEAR(model->unknowns[0].deviation, 0.15 * model->unknowns[0].guess, 1e-12);
  EXPECT_EQ(model->unknowns[3].name, "damping_ratio_2");
  EXPECT_DOUBLE_EQ(model->unknowns[3].guess, 0.005);
}

TEST(ModalModel, MovesEveryModeByItsOwnNumbers) {
  // Oracle: z'' = -2 xi omega z' - omega^2 z, written out; every mode is 1 at the tip.
  const auto model = model_registry().make(
      "modal", {{"sensor_bias", false}},
      setting_of({{Quantity::acceleration, 1.1}, {Quantity::displacement, 1.1}, {Quantity::velocity, 1.1}}));
  VectorXd state = at_guess(*model), output;
  state.head(6) << 0.01, 2e-4, 3e-5, -0.1, 0.02, 0.003;
  const double f[] = {4.0, 27.0, 70.0}, xi[] = {0.003, 0.004, 0.006};
  double expected = 0.0;
  for (int i = 0; i < 3; ++i) {
    state[model->unknown_places[2 * i]] = f[i];
    state[model->unknown_places[2 * i + 1]] = xi[i];
    const double omega = 2.0 * pi * f[i];
    expected -= omega * omega * state[i] + 2.0 * xi[i] * omega * state[3 + i];
  }
  model->motion->output(state, {}, output);
  EXPECT_NEAR(output[0], expected, 1e-11 * std::abs(expected));
  EXPECT_NEAR(output[1], state.head(3).sum(), 1e-14);
  EXPECT_NEAR(output[2], state.segment(3, 3).sum(), 1e-14);
}

TEST(ModalModel, TakesForcesByTheModalMassAtTheirPoint) {
  // Oracle: a tip force starts mode i with F / m_i; the modal mass of the first is 0.782414 kg.
  const auto model = model_registry().make("modal", {}, setting_of({{Quantity::displacement, 1.1}}, {1.1}));
  VectorXd rate;
  model->motion->rate(at_guess(*model), VectorXd::Constant(1, 2.0), rate);
  EXPECT_NEAR(rate[3], 2.0 / 0.782414, 2e-6);
}

TEST(ModalModel, AsksOnlyWhatItIsTold) {
  ModelSetting setting = setting_of({{Quantity::displacement, 1.1}});
  setting.parameters = {test::of_mode("frequency", 2), test::parameter("damping_ratio")};
  const auto model = model_registry().make("modal", {}, setting);
  ASSERT_EQ(model->unknowns.size(), 2u);
  EXPECT_EQ(model->unknowns[1].name, "damping_ratio");
  VectorXd state = at_guess(*model), rate;
  state.segment(3, 3).setOnes();
  state[model->unknown_places[1]] = 0.01;
  model->motion->rate(state, {}, rate);
  for (Index i = 0; i < 3; ++i) EXPECT_NEAR(rate[3 + i], -0.02 * model->mode_frequencies[i], 1e-9);
}

TEST(ModalModel, SaysWhatItCannotDo) {
  ModelSetting setting = setting_of({{Quantity::displacement, 1.1}});
  setting.parameters = {test::parameter("frequency")};
  EXPECT_THAT(refusal(setting), testing::HasSubstr("without a mode"));
  setting.parameters = {test::of_mode("damping_ratio", 4)};
  EXPECT_THAT(refusal(setting), testing::HasSubstr("3 modes"));
  setting.parameters = {};
  EXPECT_THAT(refusal(setting, {{"modes", 7.0}}), testing::HasSubstr("7 modes of 3 coordinates"));
  EXPECT_THAT(refusal(setting, {{"modes", 1.5}}), testing::HasSubstr("1.5 modes"));
  fem::Beam free = test::steel_beam(0.0);
  free.supports.clear();
  ModelSetting loose = test::beam_setting(free, 4, {{Quantity::displacement, 1.1}});
  EXPECT_THAT(refusal(loose), testing::HasSubstr("moves without strain"));
}

}  // namespace
}  // namespace beamid::experiments::modal_test
