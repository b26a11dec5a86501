// What sensors read of the finite-element beam as an identification model, and its derivatives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/models/banded/continuum_motion.hpp"
#include "fem/modes.hpp"
#include "filters/central_differences.hpp"
#include "tests/experiments/models/beam_model.hpp"

namespace beamid::experiments::beam_sensors_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

TEST(BeamModel, ReadsEverySensorOfExactModesAsTheBeamAtItsUnknownsMovesIt) {
  // Oracle: modes of the beam described with those values. Twelve shapes of the guess, which do not turn with
  // a region's stiffness, leave 6e-4 of frequencies.
  const std::vector<test::SensorAt> sensors{
      {Quantity::displacement, 1.1}, {Quantity::displacement, 0.55}, {Quantity::displacement, 0.275}};
  const fem::Beam whole = fem::with_nodes(test::steel_beam(0.36), {0.275, 0.55});
  ModelSetting setting = test::beam_setting(whole, 20, sensors);
  test::reduce_by(setting, "modal_truncation", {{"modes", 12.0}});
  setting.parameters = {test::in_region(0.275, 0.55), test::parameter("tip_mass")};
  const auto model = beam_model(setting);
  VectorXd state = state_at_guess(*model), output;
  set_unknown(*model, state, 0, 0.8 * model->unknowns[0].guess);
  set_unknown(*model, state, 1, 1.1 * model->unknowns[1].guess);
  using fem::BeamParameter;
  fem::Beam there =
      fem::with_value(whole, {BeamParameter::Quantity::bending_stiffness, std::pair{0.275, 0.55}},
                      0.8 * model->unknowns[0].guess);
  there = fem::with_value(there, {BeamParameter::Quantity::tip_mass, {}}, 1.1 * model->unknowns[1].guess);
  const fem::StructuralSystem system = test::beam_setting(there, 20, sensors).system;
  const fem::Modes modes = fem::modes(system, 5);
  const MatrixXd read = system.outputs * modes.shape;
  for (Index i = 0; i < 5; ++i) {
    VectorXd moved = state;
    moved[i] = 1.0;
    model->motion->output(moved, {}, output);
    for (Index k = 1; k < 3; ++k)
      EXPECT_NEAR(output[k] / output[0], read(k, i) / read(0, i), 1e-6 * std::abs(read(k, i) / read(0, i)))
          << i << ", " << k;
    EXPECT_NEAR(
        upper_eigenvalues(*model, state)[static_cast<std::size_t>(i)].imag() / modes.angular_frequency[i],
        1.0, 1e-7);
  }
}

TEST(BeamModel, GivesTheDerivativesOfEveryParameterInEveryForm) {
  // Oracle: central differences. On three modes, and on the mesh itself.
  for (const bool reduced : {true, false}) {
    ModelSetting setting = rich_beam_setting();
    if (reduced) test::reduce_by(setting, "modal_truncation", {{"modes", 3.0}});
    if (!reduced) setting.continuum->elements = 10;
    if (!reduced) {
      ModelSetting small =
          test::beam_setting(setting.continuum->structure.beam(), 7,
                             {{Quantity::acceleration, 1.1}, {Quantity::displacement, 1.1}}, {1.1});
      small.damping = setting.damping;
      small.parameters = setting.parameters;
      setting = small;
    }
    const auto model = beam_model(setting, {{"sensor_drift", true}});
    VectorXd state = state_at_guess(*model);
    for (std::size_t j = 0; j < model->unknowns.size(); ++j)
      set_unknown(*model, state, j, (j % 2 == 0 ? 1.1 : 0.9) * model->unknowns[j].guess);
    const Index r = model->motion_size();
    for (Index i = 0; i < r; ++i) {  // all modes with the same acceleration: differences keep their digits
      const double omega = model->mode_frequencies[i];
      state[i] = (i % 2 == 0 ? 1.3 : -0.8) / (omega * omega);
      state[r + i] = 0.7 / omega;
    }
    const VectorXd input = VectorXd::LinSpaced(model->motion->input_size(), 3.0, -2.0);
    MatrixXd given, difference;
    model->motion->rate_jacobian(state, input, given);
    filters::central_differences(
        [&](const VectorXd& z, VectorXd& value) { model->motion->rate(z, input, value); }, state,
        state.size(), difference);
    for (Index j = 0; j < given.cols(); ++j)
      EXPECT_LE((given.col(j) - difference.col(j)).norm(), 1e-6 * difference.col(j).norm()) << j;
    model->motion->output_jacobian(state, input, given);
    filters::central_differences(
        [&](const VectorXd& z, VectorXd& value) { model->motion->output(z, input, value); }, state,
        static_cast<Index>(setting.observations.size()), difference);
    for (Index i = 0; i < given.rows(); ++i)
      EXPECT_LE((given.row(i) - difference.row(i)).norm(), 1e-7 * difference.row(i).norm()) << i;
  }
}

TEST(BeamModel, ReadsEverySensorInTheReducedMotion) {
  // Oracle: the rows of the mesh on the lifted motion, and the equation of motion written out on the mesh.
  ModelSetting setting = rich_beam_setting();
  const auto model = beam_model(
      setting, {{"sensor_bias", false},
                {"coordinates", std::string("mesh")}});  // no reduction, 42 coordinates: the mesh itself
  ASSERT_NE(dynamic_cast<const ContinuumMotion*>(model->motion.get()), nullptr);
  const Index n = model->motion_size();
  ASSERT_EQ(n, setting.system.size());
  VectorXd state = state_at_guess(*model), output;
  const VectorXd q = model->mode_shapes.col(0), rate = 3.0 * model->mode_shapes.col(1);
  state.head(n) = q;
  state.segment(n, n) = rate;
  const VectorXd input = VectorXd::Zero(model->motion->input_size());
  model->motion->output(state, input, output);
  const MatrixXd rows = MatrixXd(setting.system.outputs);
  EXPECT_NEAR(output[1], rows.row(1).dot(rate), 1e-12);
  EXPECT_NEAR(output[2], rows.row(2).dot(q), 1e-12 * std::abs(output[2]));
  EXPECT_NEAR(output[3], rows.row(3).dot(q), 1e-12);
  const double w1 = model->mode_frequencies[0], w2 = model->mode_frequencies[1];
  // z'' = -omega^2 z - (2 xi omega + alpha + beta omega^2) z'
  const double damping = 2.0 * 0.004 * w2 + 0.1 + 1e-5 * w2 * w2;
  EXPECT_NEAR(output[0], -w1 * w1 * rows.row(0).dot(q) - damping * rows.row(0).dot(rate),
              1e-6 * std::abs(output[0]));
}

TEST(BeamModel, HasOneBehaviourOnAMeshAndOnAllItsModes) {
  // Oracle: a full basis is no reduction. Both move the same sensors, pushed and shaken.
  ModelSetting mesh = rich_beam_setting();
  mesh.parameters[6].mode.reset();
  const auto full = beam_model(mesh, {{"modes", 42.0}});
  ModelSetting modal = mesh;
  test::reduce_by(modal, "modal_truncation", {{"modes", static_cast<double>(mesh.system.size())}});
  const auto reduced = beam_model(modal);
  ASSERT_EQ(full->motion_size(), reduced->motion_size());
  VectorXd state = state_at_guess(*full), small = state_at_guess(*reduced), input(3), a, b;
  for (std::size_t j = 0; j < full->unknowns.size(); ++j) {
    const double value = (j % 2 == 0 ? 1.1 : 0.9) * full->unknowns[j].guess;
    set_unknown(*full, state, j, value);
    set_unknown(*reduced, small, j, value);
  }
  input << 3.0, -2.0, 0.7;
  for (Index i = 0; i < 4; ++i) {
    small[i] = 0.5 + static_cast<double>(i);
    state.head(full->motion_size()) += small[i] * full->mode_shapes.col(i);
  }
  full->motion->output(state, input, a);
  reduced->motion->output(small, input, b);
  for (Index i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-6 * std::abs(a[i])) << i;
}

}  // namespace
}  // namespace beamid::experiments::beam_sensors_test
