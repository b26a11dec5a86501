// Conformance of models: each keeps what the filters rely on. To be included by one file of a test program,
// which says what it runs on, in namespace beamid::test; one that takes no forces with
// testing::Values(false):
//
//     INSTANTIATE_TEST_SUITE_P(Mine, EveryModel, testing::Combine(testing::Values("my_model"),
//     testing::Bool()),
//                              by_name_and_force);
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "beamid/testing/named.hpp"
#include "beamid/testing/steel_beam.hpp"
#include "experiments/models/joint_model.hpp"
#include "fem/assembly.hpp"
#include "filters/central_differences.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::test {

/// With and without a force.
class EveryModel : public testing::TestWithParam<std::tuple<std::string, bool>> {};

inline std::string by_name_and_force(const testing::TestParamInfo<EveryModel::ParamType>& tested) {
  return std::get<0>(tested.param) + (std::get<1>(tested.param) ? "_pushed" : "_free");
}

namespace model_contracts {

using namespace experiments;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

inline const std::vector<std::vector<Quantity>> observations{
    {Quantity::displacement},
    {Quantity::velocity},
    {Quantity::acceleration},
    {Quantity::displacement, Quantity::velocity},
    {Quantity::acceleration, Quantity::displacement, Quantity::velocity}};

/// The smallest setting that every model can be made from: a steel cantilever of 8 elements, reduced to one
/// coordinate, observed at its tip. @param pushed a force there is the input.
inline ModelSetting setting_of(const std::vector<Quantity>& observed, bool pushed) {
  const fem::Beam beam = steel_beam(0.36049);
  const std::vector<fem::Point> points{fem::natural_point(beam)};
  ModelSetting setting = at_one_point(fem::assemble(beam, 8, points), observed);
  setting.reduction = reduction::reduction_registry().make("rayleigh", {});
  setting.continuum = ModelSetting::Continuum{beam, 8, points};
  for (std::size_t i = 0; i < observed.size(); ++i)
    setting.observations[i].name = setting.system.output_names[i] = "sensor_" + std::to_string(i + 1);
  if (pushed) setting.forces = {0};
  return setting;
}

inline std::unique_ptr<JointModel> make(const EveryModel::ParamType& tested,
                                        const std::vector<Quantity>& observed) {
  return model_registry().make(std::get<0>(tested), {}, setting_of(observed, std::get<1>(tested)));
}

/// A state with nothing zero in it, the unknowns near their guesses.
inline VectorXd state_of(const JointModel& model) {
  VectorXd state = VectorXd::LinSpaced(static_cast<Index>(model.motion->state_labels().size()), 0.3, 1.7);
  for (std::size_t j = 0; j < model.unknowns.size(); ++j)
    state[model.unknown_places[j]] = model.unknowns[j].to_state(1.1 * model.unknowns[j].guess);
  return state;
}

inline VectorXd input_of(const JointModel& model) {
  return VectorXd::Constant(model.motion->input_size(), 2.5);
}

/// Columns of unknowns are as large as one over them: they are compared on their own scale.
inline void expect_near(const MatrixXd& a, const MatrixXd& b, double tolerance) {
  ASSERT_EQ(a.rows(), b.rows());
  ASSERT_EQ(a.cols(), b.cols());
  for (Index j = 0; j < a.cols(); ++j)
    EXPECT_LE((a.col(j) - b.col(j)).norm(), tolerance * b.col(j).norm()) << j << "\n" << a << "\n\n" << b;
}

TEST_P(EveryModel, LabelsEveryStateAndOutput) {
  // Oracle: outputs are those observed, in that order; an unknown's own name and unit are its state's.
  for (const auto& observed : observations) {
    const auto model = make(GetParam(), observed);
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
      const bool own = unknown.form == Form::linear;  // else its logarithm or logit
      EXPECT_TRUE(own ? label.name == unknown.name : label.name.ends_with(unknown.name)) << label.name;
      EXPECT_EQ(label.unit, !own || unknown.unit.empty() ? "1" : unknown.unit);
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
    const auto model = make(GetParam(), observed);
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
  const auto model = make(GetParam(), {Quantity::acceleration, Quantity::displacement});
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
    const auto model = make(GetParam(), observed);
    VectorXd rate;
    model->motion->rate(state_of(*model), input_of(*model), rate);
    for (const Index place : model->unknown_places) EXPECT_EQ(rate[place], 0.0);
    for (const JointModel::Offset& offset : model->offsets) EXPECT_EQ(rate[offset.place], 0.0);
  }
}

TEST_P(EveryModel, AddsAnOffsetToItsChannelAlone) {
  // Oracle: a unit offset moves its own channel by one, and no other. A model need not have offsets.
  const auto model = make(GetParam(), {Quantity::acceleration, Quantity::displacement});
  for (const JointModel::Offset& offset : model->offsets) {
    if (offset.drift) continue;
    VectorXd state = state_of(*model), before, after;
    model->motion->output(state, input_of(*model), before);
    state[offset.place] += 1.0;
    model->motion->output(state, input_of(*model), after);
    for (Index i = 0; i < after.size(); ++i)
      EXPECT_NEAR(after[i] - before[i], i == offset.channel ? 1.0 : 0.0, 1e-12 * std::abs(after[i])) << i;
  }
}

TEST_P(EveryModel, StatesTheMassAtItsOutput) {
  // Oracle: Rayleigh's 33/140 of the beam's mass, and the tip's.
  const auto model = make(GetParam(), {Quantity::displacement});
  EXPECT_NEAR(model->equivalent_mass, 33.0 / 140.0 * 3.055 + 0.36049, 1e-9);
  EXPECT_EQ(model->motion_size(), 1);
  EXPECT_EQ(model->mode_frequencies.size(), 1);
}

TEST_P(EveryModel, MovesInItsModeAtTheGuess) {
  // Oracle: z'' = -omega^2 z in the first mode's shape where nothing is damped or pushed.
  const auto model = make(GetParam(), {Quantity::displacement});
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
  setting.parameters.emplace_back().quantity = "colour";
  EXPECT_THROW(model_registry().make(std::get<0>(GetParam()), {}, setting), std::invalid_argument);
}

TEST_P(EveryModel, DescribesItselfAndItsOptions) {
  expect_described(model_registry().find(std::get<0>(GetParam())));
}

}  // namespace model_contracts
}  // namespace beamid::test
