// Conformance: every registered model keeps what the filters rely on. A new one is found by itself.
#include <gtest/gtest.h>

#include <set>

#include "experiments/models/joint_model.hpp"
#include "filters/central_differences.hpp"
#include "filters/discrete_model.hpp"
#include "tests/experiments/models/beam_setting.hpp"

namespace beamid::experiments::conformance_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

const std::vector<std::vector<Quantity>> observations{
    {Quantity::displacement},
    {Quantity::velocity},
    {Quantity::acceleration},
    {Quantity::displacement, Quantity::velocity},
    {Quantity::acceleration, Quantity::displacement, Quantity::velocity}};

// The smallest setting that every model can be made from: a beam reduced to one coordinate. Half of the tests
// push it, too.
ModelSetting setting_of(const std::vector<Quantity>& observed, bool pushed) {
  std::vector<test::SensorAt> sensors;
  for (const Quantity quantity : observed) sensors.push_back({quantity, 1.10});
  ModelSetting setting = test::beam_setting(test::steel_beam(0.36049), 8, sensors,
                                            pushed ? std::vector<double>{1.10} : std::vector<double>{});
  test::reduce_by(setting, "rayleigh");
  return setting;
}

class EveryModel : public testing::TestWithParam<std::tuple<std::string, bool>> {
 protected:
  std::unique_ptr<JointModel> make(const std::vector<Quantity>& observed) {
    return model_registry().make(std::get<0>(GetParam()), {}, setting_of(observed, std::get<1>(GetParam())));
  }
  // A state with nothing zero in it, the unknowns near their guesses.
  static VectorXd state_of(const JointModel& model) {
    VectorXd state = VectorXd::LinSpaced(static_cast<Index>(model.motion->state_labels().size()), 0.3, 1.7);
    for (std::size_t j = 0; j < model.unknowns.size(); ++j)
      state[model.unknown_places[j]] = model.unknowns[j].to_state(1.1 * model.unknowns[j].guess);
    return state;
  }
  static VectorXd input_of(const JointModel& model) {
    return VectorXd::Constant(model.motion->input_size(), 2.5);
  }
  // Columns of unknowns are as large as one over them: they are compared on their own scale.
  static void expect_near(const MatrixXd& a, const MatrixXd& b, double tolerance) {
    ASSERT_EQ(a.rows(), b.rows());
    ASSERT_EQ(a.cols(), b.cols());
    for (Index j = 0; j < a.cols(); ++j)
      EXPECT_LE((a.col(j) - b.col(j)).norm(), tolerance * b.col(j).norm()) << j << "\n" << a << "\n\n" << b;
  }
};

TEST_P(EveryModel, LabelsEveryStateAndOutput) {
  // Oracle: outputs are those observed, in that order; an unknown's own name and unit are its state's.
  for (const auto& observed : observations) {
    const auto model = make(observed);
    const auto states = model->motion->state_labels();
    std::set<std::string> names;
    for (const filters::Label& label : states) {
      EXPECT_FALSE(label.unit.empty()) << label.name;
      EXPECT_TRUE(names.insert(label.name).second) << label.name << " is there twice";
    }
    ASSERT_FALSE(model->unknowns.empty());
    ASSERT_EQ(model->unknowns.size(), model->unknown_places.size());
    for (std::size_t j = 0; j < model->unknowns.size(); ++j) {
      const Unknown& unknown = model->unknowns[j];
      const filters::Label& label = states.at(static_cast<std::size_t>(model->unknown_places[j]));
      EXPECT_EQ(label.name, unknown.name);
      EXPECT_EQ(label.unit, unknown.unit.empty() ? "1" : unknown.unit);
      EXPECT_FALSE(unknown.quantity.empty());
      EXPECT_GT(unknown.guess, 0.0);
      EXPECT_GT(unknown.deviation, 0.0);
    }
    const auto outputs = model->motion->output_labels();
    ASSERT_EQ(outputs.size(), observed.size());
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      EXPECT_EQ(outputs[i].name, to_string(observed[i]));
      EXPECT_EQ(outputs[i].unit, si_unit(observed[i]));
    }
  }
}

TEST_P(EveryModel, GivesTheDerivativesOfItsRateAndOutput) {
  // Oracle: central differences.
  for (const auto& observed : observations) {
    const auto model = make(observed);
    const VectorXd state = state_of(*model), input = input_of(*model);
    MatrixXd given, difference;
    model->motion->rate_jacobian(state, input, given);
    const auto rate = [&](const VectorXd& z, VectorXd& value) { model->motion->rate(z, input, value); };
    filters::central_differences(rate, state, state.size(), difference);
    expect_near(given, difference, 1e-6);
    model->motion->output_jacobian(state, input, given);
    const auto output = [&](const VectorXd& z, VectorXd& value) { model->motion->output(z, input, value); };
    filters::central_differences(output, state, static_cast<Index>(observed.size()), difference);
    expect_near(given, difference, 1e-6);
  }
}

TEST_P(EveryModel, GivesTheDerivativesOfItsStep) {
  // Oracle: central differences of the step, of the registered scheme or of the model's own.
  const auto model = make({Quantity::acceleration, Quantity::displacement});
  const VectorXd state = state_of(*model), input = input_of(*model);
  const bool linear = dynamic_cast<const filters::LinearMotion*>(model->motion.get()) != nullptr;
  for (const char* const scheme : {linear ? "exponential" : "runge_kutta_4", "pade"}) {
    const auto step = filters::discretise(model->motion, 1e-3, scheme, {{}, MatrixXd::Identity(2, 2)});
    VectorXd next;
    MatrixXd given, difference;
    step->linearised_transition(state, input, next, given);
    const auto move = [&](const VectorXd& z, VectorXd& value) { step->transition(z, input, value); };
    filters::central_differences(move, state, state.size(), difference);
    expect_near(given, difference, 1e-6);
  }
}

TEST_P(EveryModel, LeavesItsParametersAtRest) {
  // Oracle: theta' = 0, whatever the motion does.
  for (const auto& observed : observations) {
    const auto model = make(observed);
    VectorXd rate;
    model->motion->rate(state_of(*model), input_of(*model), rate);
    for (const Index place : model->unknown_places) EXPECT_EQ(rate[place], 0.0);
    for (const JointModel::Offset& offset : model->offsets) EXPECT_EQ(rate[offset.place], 0.0);
  }
}

TEST_P(EveryModel, GivesEveryAccelerometerAnOffset) {
  // Oracle: a unit offset moves its own channel by one, and no other.
  const auto model = make({Quantity::acceleration, Quantity::displacement});
  ASSERT_EQ(model->offsets.size(), 1u);
  EXPECT_EQ(model->offsets[0].channel, 0);
  VectorXd state = state_of(*model), before, after;
  model->motion->output(state, input_of(*model), before);
  state[model->offsets[0].place] += 1.0;
  model->motion->output(state, input_of(*model), after);
  EXPECT_NEAR(after[0] - before[0], 1.0, 1e-12 * std::abs(after[0]));
  EXPECT_EQ(after[1], before[1]);
}

TEST_P(EveryModel, TellsTheMassAtItsOutput) {
  // Oracle: Rayleigh's 33/140 of the beam's mass, and the tip's.
  const auto model = make({Quantity::displacement});
  EXPECT_NEAR(model->equivalent_mass, 33.0 / 140.0 * 3.055 + 0.36049, 1e-9);
  EXPECT_EQ(model->motion_size(), 1);
  EXPECT_EQ(model->mode_frequencies.size(), 1);
}

TEST_P(EveryModel, MovesInItsModeAtTheGuess) {
  // Oracle: z'' = -omega^2 z in the first mode's shape where nothing is damped or pushed.
  const auto model = make({Quantity::displacement});
  const Index r = model->motion_size();
  VectorXd state = VectorXd::Zero(static_cast<Index>(model->motion->state_labels().size())), rate, output;
  for (std::size_t j = 0; j < model->unknowns.size(); ++j)
    state[model->unknown_places[j]] = model->unknowns[j].to_state(model->unknowns[j].guess);
  constexpr double little = 1e-9;  // [m]: so small that any motion is linear
  state.head(r) = little * model->mode_shapes.col(0);
  model->motion->rate(state, VectorXd::Zero(model->motion->input_size()), rate);
  const double square = model->mode_frequencies[0] * model->mode_frequencies[0];
  EXPECT_LE((rate.segment(r, r) + square * state.head(r)).norm(), 1e-9 * square * state.head(r).norm());
  model->motion->output(state, VectorXd::Zero(model->motion->input_size()), output);
  EXPECT_NEAR(std::abs(output[0]), little, 1e-12 * little);
}

TEST_P(EveryModel, RefusesUnknownOptionsAndWhatItCannotObserve) {
  const std::string name = std::get<0>(GetParam());
  ModelSetting setting = setting_of({Quantity::velocity}, std::get<1>(GetParam()));
  EXPECT_THROW(model_registry().make(name, {{"no_such_option", 1.0}}, setting), std::invalid_argument);
  setting.observations[0].quantity = Quantity::force;
  EXPECT_THROW(model_registry().make(name, {}, setting), std::invalid_argument);
  setting.observations.clear();
  EXPECT_THROW(model_registry().make(name, {}, setting), std::invalid_argument);
}

TEST_P(EveryModel, RefusesParametersItDoesNotHave) {
  ModelSetting setting = setting_of({Quantity::velocity}, std::get<1>(GetParam()));
  setting.parameters = {test::parameter("colour")};
  EXPECT_THROW(model_registry().make(std::get<0>(GetParam()), {}, setting), std::invalid_argument);
}

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const auto& [name, entry] : model_registry().entries()) result.push_back(name);
  return result;
}
INSTANTIATE_TEST_SUITE_P(Registered, EveryModel,
                         testing::Combine(testing::ValuesIn(names()), testing::Bool()),
                         [](const auto& tested) {
                           return std::get<0>(tested.param) +
                                  (std::get<1>(tested.param) ? "_pushed" : "_free");
                         });

}  // namespace
}  // namespace beamid::experiments::conformance_test
