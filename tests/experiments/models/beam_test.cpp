// The finite-element beam as an identification model.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/models/banded/continuum_motion.hpp"
#include "fem/exact/exact_cantilever.hpp"
#include "fem/modes.hpp"
#include "filters/central_differences.hpp"
#include "filters/filter_run.hpp"
#include "tests/experiments/models/beam_setting.hpp"

namespace beamid::experiments::beam_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

std::unique_ptr<JointModel> beam(const ModelSetting& setting, const filters::Options& options = {}) {
  return model_registry().make("beam", options, setting);
}

VectorXd at_guess(const JointModel& model) {
  VectorXd state = VectorXd::Zero(static_cast<Index>(model.motion->state_labels().size()));
  for (std::size_t j = 0; j < model.unknowns.size(); ++j)
    state[model.unknown_places[j]] = model.unknowns[j].to_state(model.unknowns[j].guess);
  return state;
}

void set(const JointModel& model, VectorXd& state, std::size_t j, double value) {
  state[model.unknown_places[j]] = model.unknowns[j].to_state(value);
}

MatrixXd motion_matrix(const JointModel& model, const VectorXd& state) {
  MatrixXd a;
  dynamic_cast<const filters::LinearMotion&>(*model.motion).motion_matrix(state, a);
  return a;
}

// Eigenvalues of the motion above the real axis, by frequency.
std::vector<std::complex<double>> eigenvalues(const JointModel& model, const VectorXd& state) {
  const Eigen::VectorXcd all = motion_matrix(model, state).eigenvalues();
  std::vector<std::complex<double>> upper;
  for (const auto& value : all)
    if (value.imag() > 0.0) upper.push_back(value);
  std::sort(upper.begin(), upper.end(), [](auto a, auto b) { return a.imag() < b.imag(); });
  return upper;
}

std::string refusal(const ModelSetting& setting, const filters::Options& options = {}) {
  try {
    beam(setting, options);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing was thrown";
}

fem::Beam elastic_root() {
  fem::Beam beam = test::steel_beam(0.36);
  beam.supports = {{0.0, true, false}};
  beam.springs = {{0.0, 0.0, 4e3, 0.0}};
  beam.bodies[0].rotary_inertia = 1e-3;
  return beam;
}

const std::vector<ParameterChoice> everything{test::in_region(0.0, 0.3),
                                              test::in_region(0.3, 1.1),
                                              test::parameter("tip_mass"),
                                              test::parameter("tip_rotary_inertia"),
                                              test::parameter("root_rotational_stiffness"),
                                              test::of_mode("damping_ratio", 1),
                                              test::parameter("damping_ratio"),
                                              test::parameter("mass_damping"),
                                              test::parameter("stiffness_damping")};

ModelSetting rich_setting() {
  ModelSetting setting = test::beam_setting(elastic_root(), 20,
                                            {{Quantity::acceleration, 1.1},
                                             {Quantity::velocity, 0.5},
                                             {Quantity::strain, 0.3},
                                             {Quantity::displacement, 1.1}},
                                            {1.1, 0.5});
  setting.continuum->structure = fem::with_nodes(setting.continuum->structure.beam(), {0.3});
  setting.forces.push_back(setting.system.inputs.cols() - 1);  // the base, too
  setting.damping = fem::ModalDamping{{0.004, 0.01}};
  setting.parameters = everything;
  setting.parameters[7].guess = 0.1;
  setting.parameters[8].guess = 1e-5;
  setting.parameters[1].form = Form::logarithmic;
  setting.parameters[2].lower = 0.1;
  setting.parameters[2].upper = 1.0;
  return setting;
}

TEST(BeamModel, HasTheFrequenciesOfTheBeamWithOtherParameters) {
  // Oracle: the beam with these values, assembled and solved anew. Without a reduction nothing is
  // approximate.
  fem::Cantilever steel = test::steel_beam(0.36);
  ModelSetting setting = test::beam_setting(steel, 8, {{Quantity::displacement, 1.1}});
  setting.parameters = {test::parameter("bending_stiffness"), test::parameter("tip_mass")};
  const auto model = beam(setting);
  VectorXd state = at_guess(*model);
  set(*model, state, 0, 1.3 * steel.bending_stiffness);
  set(*model, state, 1, 0.1);
  steel.bending_stiffness *= 1.3;
  steel.tip_mass = 0.1;
  const VectorXd expected = fem::modes(fem::assemble(steel, 8), 5).angular_frequency;
  const auto found = eigenvalues(*model, state);
  for (Index i = 0; i < 5; ++i)
    EXPECT_NEAR(found[static_cast<std::size_t>(i)].imag(), expected[i], 1e-8 * expected[i]);
}

TEST(BeamModel, FollowsTheExactFrequencyThroughAFewModes) {
  // Oracle: the exact cantilever with a tip mass 20 % off that of the guess. Shapes of the guess make the
  // error of second order: two of them, by their deflections and more, leave 1e-6; exact modes follow.
  fem::Cantilever steel = test::steel_beam(1.338090);
  const ModelSetting plain = test::beam_setting(steel, 40, {{Quantity::displacement, 1.1}});
  const double believed = steel.tip_mass;
  steel.tip_mass *= 1.2;
  const double exact = fem::ExactMode(steel, 1).angular_frequency();
  const auto error_of = [&](const std::string& reduction, const filters::Options& options) {
    ModelSetting setting = plain;
    test::reduce_by(setting, reduction, options);
    setting.parameters = {test::parameter("tip_mass")};
    const auto model = beam(setting);
    VectorXd state = at_guess(*model);
    set(*model, state, 0, 1.2 * believed);
    return std::abs(eigenvalues(*model, state)[0].imag() / exact - 1.0);
  };
  EXPECT_LT(error_of("modal_truncation", {{"modes", 3.0}, {"static_correction", true}}), 2e-6);
  EXPECT_LT(error_of("modal_truncation", {{"modes", 3.0}}), 1e-8);
  EXPECT_LT(error_of("serep", {{"masters_m", std::vector<double>{0.5, 0.8, 1.1}}}), 1e-8);
}

TEST(BeamModel, ReadsEverySensorOfExactModesAsTheBeamAtItsUnknownsMovesIt) {
  // Oracle: modes of the beam described with those values. Twelve shapes of the guess, which do not turn with
  // a region's stiffness, leave 6e-4 of frequencies.
  const std::vector<test::SensorAt> sensors{
      {Quantity::displacement, 1.1}, {Quantity::displacement, 0.55}, {Quantity::displacement, 0.275}};
  const fem::Beam whole = fem::with_nodes(test::steel_beam(0.36), {0.275, 0.55});
  ModelSetting setting = test::beam_setting(whole, 20, sensors);
  test::reduce_by(setting, "modal_truncation", {{"modes", 12.0}});
  setting.parameters = {test::in_region(0.275, 0.55), test::parameter("tip_mass")};
  const auto model = beam(setting);
  VectorXd state = at_guess(*model), output;
  set(*model, state, 0, 0.8 * model->unknowns[0].guess);
  set(*model, state, 1, 1.1 * model->unknowns[1].guess);
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
    EXPECT_NEAR(eigenvalues(*model, state)[static_cast<std::size_t>(i)].imag() / modes.angular_frequency[i],
                1.0, 1e-7);
  }
}

TEST(BeamModel, GivesEveryModeItsDampingRatio) {
  // Oracle: -Re lambda / |lambda| of the motion; the ratios described, and the one asked about.
  ModelSetting setting = test::beam_setting(test::steel_beam(0.36), 20, {{Quantity::acceleration, 1.1}});
  test::reduce_by(setting, "modal_truncation", {{"modes", 4.0}});
  setting.damping = fem::ModalDamping{{0.004, 0.01, 0.02}};
  setting.parameters = {test::parameter("bending_stiffness"), test::of_mode("damping_ratio", 2)};
  const auto model = beam(setting);
  EXPECT_DOUBLE_EQ(model->unknowns[1].guess, 0.01);
  EXPECT_EQ(model->unknowns[1].name, "damping_ratio_2");
  VectorXd state = at_guess(*model);
  set(*model, state, 0, 1.5 * model->unknowns[0].guess);  // ratios stay what they are
  set(*model, state, 1, 0.03);
  const auto found = eigenvalues(*model, state);
  const double expected[] = {0.004, 0.03, 0.02, 0.02};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(-found[i].real() / std::abs(found[i]), expected[i], 1e-9);
}

TEST(BeamModel, DampingRatiosHoldToSecondOrderWhereShapesChange) {
  // Oracle: the definition of the ratio; the Rayleigh quotient of the guess's shapes errs by the square of
  // the change.
  ModelSetting setting = test::beam_setting(test::steel_beam(0.36), 20, {{Quantity::displacement, 1.1}});
  test::reduce_by(setting, "krylov", {{"moments", 5.0}});
  setting.parameters = {test::parameter("tip_mass"), test::parameter("damping_ratio")};
  const auto model = beam(setting);
  double before = 0.0;
  for (const double change : {0.2, 0.1, 0.05}) {
    VectorXd state = at_guess(*model);
    set(*model, state, 0, (1.0 + change) * model->unknowns[0].guess);
    const auto lambda = eigenvalues(*model, state)[1];
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
  const auto model = beam(setting);
  VectorXd state = at_guess(*model);
  set(*model, state, 0, 1.2 * model->unknowns[0].guess);
  for (const auto& lambda : eigenvalues(*model, state))
    EXPECT_NEAR(-lambda.real() / std::abs(lambda) / model->unknowns[1].guess, 1.0, 1e-9);
}

TEST(BeamModel, KeepsRayleighsDampingWhereNoRatioIsAsked) {
  // Oracle: fem::damping_ratios of the law at the modes' frequencies.
  ModelSetting setting = test::beam_setting(test::steel_beam(0.36), 20, {{Quantity::displacement, 1.1}});
  test::reduce_by(setting, "modal_truncation", {{"modes", 3.0}});
  setting.damping = fem::RayleighDamping{{3.0, 0.01}, {60.0, 0.02}};
  for (const std::string asked : {"mass_damping", "damping_ratio"}) {
    setting.parameters = {test::parameter(asked)};
    const auto model = beam(setting);
    VectorXd state = at_guess(*model);
    if (asked == "damping_ratio") set(*model, state, 0, 0.015);
    const auto found = eigenvalues(*model, state);
    const VectorXd ratios = fem::damping_ratios(setting.damping, model->mode_frequencies);
    for (Index i = 0; i < 3; ++i) {
      const auto lambda = found[static_cast<std::size_t>(i)];
      EXPECT_NEAR(-lambda.real() / std::abs(lambda), asked == "damping_ratio" ? 0.015 : ratios[i], 1e-10);
    }
  }
}

TEST(BeamModel, GivesTheDerivativesOfEveryParameterInEveryForm) {
  // Oracle: central differences. On three modes, and on the mesh itself.
  for (const bool reduced : {true, false}) {
    ModelSetting setting = rich_setting();
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
    const auto model = beam(setting, {{"sensor_drift", true}});
    VectorXd state = at_guess(*model);
    for (std::size_t j = 0; j < model->unknowns.size(); ++j)
      set(*model, state, j, (j % 2 == 0 ? 1.1 : 0.9) * model->unknowns[j].guess);
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
  ModelSetting setting = rich_setting();
  const auto model =
      beam(setting, {{"sensor_bias", false},
                     {"coordinates", std::string("mesh")}});  // no reduction, 42 coordinates: the mesh itself
  ASSERT_NE(dynamic_cast<const ContinuumMotion*>(model->motion.get()), nullptr);
  const Index n = model->motion_size();
  ASSERT_EQ(n, setting.system.size());
  VectorXd state = at_guess(*model), output;
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
  ModelSetting mesh = rich_setting();
  mesh.parameters[6].mode.reset();
  const auto full = beam(mesh, {{"modes", 42.0}});
  ModelSetting modal = mesh;
  test::reduce_by(modal, "modal_truncation", {{"modes", static_cast<double>(mesh.system.size())}});
  const auto reduced = beam(modal);
  ASSERT_EQ(full->motion_size(), reduced->motion_size());
  VectorXd state = at_guess(*full), small = at_guess(*reduced), input(3), a, b;
  for (std::size_t j = 0; j < full->unknowns.size(); ++j) {
    const double value = (j % 2 == 0 ? 1.1 : 0.9) * full->unknowns[j].guess;
    set(*full, state, j, value);
    set(*reduced, small, j, value);
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

TEST(BeamModel, FindsStiffnessAndDampingOfASimulatedBeam) {
  // Oracle: the values the record was made with, by the filter that is exact on this model; no noise.
  ModelSetting setting = test::beam_setting(test::steel_beam(0.36), 20,
                                            {{Quantity::acceleration, 1.1}, {Quantity::strain, 0.0}});
  test::reduce_by(setting, "modal_truncation", {{"modes", 2.0}});
  const auto model = beam(setting);
  const double dt = 1e-3, stiffness = 1.1 * model->unknowns[0].guess, ratio = 0.7 * model->unknowns[1].guess;
  const MatrixXd noise = VectorXd(Eigen::Vector2d(1e-4, 1e-14)).asDiagonal();
  const auto step = filters::discretise(model->motion, dt, "exponential", {{}, noise});
  VectorXd truth = at_guess(*model), next;
  truth[0] = 0.012;
  truth[1] = 1e-4;
  set(*model, truth, 0, stiffness);
  set(*model, truth, 1, ratio);
  filters::Measurements record{VectorXd::LinSpaced(3000, 0.0, 2.999), MatrixXd(2, 3000), {}};
  for (Index k = 0; k < 3000; ++k) {
    VectorXd output;
    step->output(truth, {}, output);
    record.outputs.col(k) = output;
    step->transition(truth, {}, next);
    truth = next;
  }
  filters::Gaussian start{at_guess(*model), {}};
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
              testing::HasSubstr("asked about twice"));
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
  const auto model = beam(setting);
  EXPECT_EQ(model->unknowns[0].name, "bending_stiffness_1");
  EXPECT_EQ(model->unknowns[1].name, "crack");
  EXPECT_EQ(model->unknowns[2].name, "bending_stiffness_2");
  EXPECT_TRUE(model->unknowns[2].nuisance);
  EXPECT_NEAR(model->unknowns[1].deviation, 0.3 * model->unknowns[1].guess, 1e-12);
}

}  // namespace
}  // namespace beamid::experiments::beam_test
