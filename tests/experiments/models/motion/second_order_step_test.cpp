// The models' own steps against the registered schemes, which form the exponential of the whole motion.
#include <gtest/gtest.h>

#include <unsupported/Eigen/MatrixFunctions>

#include "filters/central_differences.hpp"
#include "filters/discrete_model.hpp"
#include "tests/experiments/models/beam_setting.hpp"

namespace beamid::experiments::second_order_step_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

struct Case {
  std::string name;
  std::string model;
  int modes;
  std::vector<ParameterChoice> parameters;
  std::vector<double> forces;
  bool drift;

  friend void PrintTo(const Case& c, std::ostream* stream) { *stream << c.name; }
};

ParameterChoice logarithmic(ParameterChoice choice) {
  choice.form = Form::logarithmic;
  return choice;
}

std::vector<Case> cases() {
  const std::vector<ParameterChoice> stiffness_and_damping{logarithmic(test::parameter("bending_stiffness")),
                                                           test::parameter("damping_ratio")};
  const std::vector<ParameterChoice> many{test::in_region(0.0, 0.3), logarithmic(test::in_region(0.3, 1.1)),
                                          test::parameter("tip_mass"), test::of_mode("damping_ratio", 1),
                                          test::parameter("damping_ratio")};
  return {{"OneOscillator", "beam", 1, stiffness_and_damping, {}, false},
          {"Oscillators", "beam", 4, stiffness_and_damping, {}, true},
          {"OscillatorsUnderForce", "beam", 4, stiffness_and_damping, {1.1, 0.5}, false},
          {"Coupled", "beam", 3, many, {}, false},
          {"CoupledWithDrift", "beam", 3, many, {}, true},
          {"CoupledUnderForce", "beam", 3, many, {1.1}, true},
          {"CoupledAndFast", "beam", 10, many, {0.6}, false},
          {"Modal", "modal", 4, {}, {}, true},
          {"ModalUnderForce", "modal", 4, {}, {1.1}, false}};
}

class OwnStep : public testing::TestWithParam<std::tuple<Case, std::string>> {
 protected:
  void SetUp() override {
    const Case& c = std::get<0>(GetParam());
    const fem::Beam beam = fem::with_nodes(test::steel_beam(0.36), {0.3});
    ModelSetting setting = test::beam_setting(
        beam, 20, {{Quantity::acceleration, 1.1}, {Quantity::displacement, 0.5}, {Quantity::strain, 0.0}},
        c.forces);
    test::reduce_by(setting, "modal_truncation", {{"modes", static_cast<double>(c.modes)}});
    setting.parameters = c.parameters;
    setting.damping = fem::ModalDamping{{0.004, 0.01}};
    model_ = model_registry().make(c.model, {{"sensor_drift", c.drift}}, setting);
    const auto linear = std::dynamic_pointer_cast<const filters::LinearMotion>(model_->motion);
    scheme_ = filters::scheme_registry().make(std::get<1>(GetParam()), {});
    const auto outputs = static_cast<Index>(model_->motion->output_labels().size());
    step_ =
        model_->motion->structured(dt, std::get<1>(GetParam()), {{}, MatrixXd::Identity(outputs, outputs)});
    ASSERT_NE(step_, nullptr);
    // Nothing zero, and the parameters 20 % off the guess at which the shapes were made.
    state_ = VectorXd::LinSpaced(static_cast<Index>(model_->motion->state_labels().size()), 0.3, 1.7) * 1e-3;
    for (std::size_t j = 0; j < model_->unknowns.size(); ++j)
      state_[model_->unknown_places[j]] =
          model_->unknowns[j].to_state(model_->unknowns[j].guess * (j % 2 == 0 ? 1.2 : 0.8));
    input_ = VectorXd::LinSpaced(model_->motion->input_size(), 1.5, -2.5);
  }

  // Entries of a column differ in unit by powers of omega: each row is compared on its own scale.
  static void expect_near(const MatrixXd& a, const MatrixXd& b, double tolerance) {
    ASSERT_EQ(a.rows(), b.rows());
    ASSERT_EQ(a.cols(), b.cols());
    for (Index i = 0; i < a.rows(); ++i)
      for (Index j = 0; j < a.cols(); ++j)
        EXPECT_NEAR(a(i, j), b(i, j),
                    tolerance * std::max(b.row(i).cwiseAbs().maxCoeff(), b.col(j).cwiseAbs().maxCoeff()))
            << i << " " << j;
  }

  static constexpr double dt = 1e-3;
  std::unique_ptr<JointModel> model_;
  std::unique_ptr<filters::Scheme> scheme_;
  std::unique_ptr<filters::DiscreteModel> step_;
  VectorXd state_, input_;
};

TEST_P(OwnStep, IsTheSchemes) {
  // Oracle: the registered scheme on the same motion.
  VectorXd next, expected;
  MatrixXd tangent, expected_tangent;
  scheme_->step(*model_->motion, state_, input_, dt, expected, &expected_tangent);
  step_->linearised_transition(state_, input_, next, tangent);
  // The general exponential does not scale by the frequencies. At omega dt = 8 its own error is 1e-8.
  const double digits = std::get<0>(GetParam()).modes > 4 ? 1e-6 : 1e-11;
  expect_near(next, expected, digits);
  expect_near(tangent, expected_tangent, digits);
  VectorXd again;
  step_->transition(state_, input_, again);
  EXPECT_EQ(again, next);
}

TEST_P(OwnStep, IsTheSchemesUnderAForceThatIsAPolynomialOfTheStep) {
  // Oracle: likewise.
  const Index m = input_.size();
  if (m == 0) GTEST_SKIP();
  for (const Index degree : {1, 4}) {
    const VectorXd path = VectorXd::LinSpaced(m * (degree + 1), 1.5, -2.5);
    VectorXd next, expected;
    MatrixXd tangent, expected_tangent;
    scheme_->step(*model_->motion, state_, path, dt, expected, &expected_tangent);
    step_->linearised_transition(state_, path, next, tangent);
    const double digits = std::get<0>(GetParam()).modes > 4 ? 1e-6 : 1e-11;
    expect_near(next, expected, digits);
    expect_near(tangent, expected_tangent, digits);
    step_->output(state_, path, next);
    step_->output(state_, path.head(m), expected);
    EXPECT_EQ(next, expected);
    step_->output_jacobian(state_, path, tangent);
    step_->output_jacobian(state_, path.head(m), expected_tangent);
    EXPECT_EQ(tangent, expected_tangent);
  }
}

// A record walked at one set of unknowns is read by matrices, made once as many readings were taken as they
// have columns. Oracle: the readings of the motion itself, also where the unknowns move on.
TEST_P(OwnStep, ReadsAsTheMotionDoesHoweverLongTheUnknownsStay) {
  constexpr double digits = 1e-13;
  VectorXd state = state_, input = input_, output, expected;
  MatrixXd jacobian, expected_jacobian;
  const auto enough = static_cast<int>(state.size() + input.size()) + 3;
  for (int k = 0; k < 2 * enough; ++k) {
    state = state_ + 1e-4 * VectorXd::LinSpaced(state.size(), -k, 0.5 * k).array().sin().matrix();
    for (const Index place : model_->unknown_places) state[place] = state_[place] * (k < enough ? 1.0 : 1.05);
    input = input_ * std::cos(0.3 * k);
    step_->output_jacobian(state, input, jacobian);
    step_->output(state, input, output);
    model_->motion->output(state, input, expected);
    model_->motion->output_jacobian(state, input, expected_jacobian);
    expect_near(output, expected, digits);
    expect_near(jacobian, expected_jacobian, digits);
  }
}

TEST_P(OwnStep, IsTheExponentialToTwelveDigitsOrAllThatItsSizeLeaves) {
  // Oracle: the exponential of the motion augmented by input and derivative, in 64-bit significands.
  if (std::get<1>(GetParam()) != "exponential") GTEST_SKIP();
  const double digits = std::get<0>(GetParam()).modes > 4 ? 3e-11 : 1e-12;
  using Long = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const auto& motion = dynamic_cast<const filters::LinearMotion&>(*model_->motion);
  const Index l = motion.motion_size(), m = motion.input_size(), size = l + m;
  VectorXd next;
  MatrixXd tangent, matrix, inputs;
  step_->linearised_transition(state_, input_, next, tangent);
  Long held = Long::Zero(size, size), moved(size, 1);
  motion.motion_matrix(state_, matrix);
  held.topLeftCorner(l, l) = matrix.cast<long double>();
  motion.input_matrix(state_, inputs);
  held.topRightCorner(l, m) = inputs.cast<long double>();
  moved.topRows(l) = state_.head(l).cast<long double>();
  moved.bottomRows(m) = input_.cast<long double>();
  const Long whole = Long(held * static_cast<long double>(dt)).exp();
  expect_near(next.head(l), (whole * moved).topRows(l).cast<double>(), digits);
  expect_near(tangent.topLeftCorner(l, l), whole.topLeftCorner(l, l).cast<double>(), digits);
  for (Index j = 0; j < static_cast<Index>(model_->unknowns.size()); ++j) {
    Long slope = Long::Zero(size, size), both = Long::Zero(2 * size, 2 * size);
    motion.motion_matrix_derivative(state_, j, matrix);
    motion.input_matrix_derivative(state_, j, inputs);
    slope.topLeftCorner(l, l) = matrix.cast<long double>();
    slope.topRightCorner(l, m) = inputs.cast<long double>();
    both.topLeftCorner(size, size) = both.bottomRightCorner(size, size) = held;
    both.topRightCorner(size, size) = slope;
    const Long derivative = Long(both * static_cast<long double>(dt)).exp().topRightCorner(size, size);
    expect_near(tangent.col(l + j).head(l), (derivative * moved).topRows(l).cast<double>(), digits);
  }
}

TEST_P(OwnStep, MovesDirectionsByItsTangent) {
  // Oracle: the tangent as a matrix.
  VectorXd next;
  MatrixXd tangent, directions = MatrixXd::Random(state_.size(), 3);
  step_->linearised_transition(state_, input_, next, tangent);
  const MatrixXd expected = tangent * directions;
  step_->move(state_, input_, next, directions);
  expect_near(directions, expected, 1e-14);
}

TEST_P(OwnStep, MovesAlikeHoweverOftenTheUnknownsStay) {
  // Oracle: its first step, which holds nothing yet.
  const Index m = input_.size();
  const VectorXd path = VectorXd::LinSpaced(2 * m, 1.5, -2.5);
  VectorXd first, next;
  MatrixXd tangent, later;
  step_->linearised_transition(state_, path, first, tangent);
  const double digits = std::get<0>(GetParam()).modes > 4 ? 1e-11 : 1e-13;
  for (int k = 0; k < 40; ++k) {
    step_->linearised_transition(state_, path, next, later);
    expect_near(next, first, digits);
    expect_near(later, tangent, digits);
  }
  // A path of another degree, and other unknowns, behind it.
  step_->linearised_transition(state_, input_, next, later);
  step_->transition(state_, input_, first);
  expect_near(next, first, digits);
  for (const Index place : model_->unknown_places) state_[place] *= 1.01;
  step_->linearised_transition(state_, path, next, later);
  step_->transition(state_, path, first);
  EXPECT_EQ(next, first);
}

TEST_P(OwnStep, OfManySubstepsIsSoManyShortSteps) {
  // Oracle: the tangent of 256 steps of this length is the product of theirs.
  if (std::get<1>(GetParam()) != "exponential") GTEST_SKIP();
  constexpr int steps = 256;
  const auto outputs = static_cast<Index>(model_->motion->output_labels().size());
  const auto whole =
      model_->motion->structured(steps * dt, "exponential", {{}, MatrixXd::Identity(outputs, outputs)});
  VectorXd now = state_, next;
  MatrixXd product = MatrixXd::Identity(state_.size(), state_.size()), tangent;
  for (int k = 0; k < steps; ++k) {
    step_->linearised_transition(now, input_, next, tangent);
    product = tangent * product;
    now = next;
  }
  whole->linearised_transition(state_, input_, next, tangent);
  expect_near(next, now, 1e-9);
  expect_near(tangent, product, 1e-9);
}

TEST_P(OwnStep, RemembersNothingOfTheUnknownsBefore) {
  // Oracle: a step that was never used with other unknowns.
  VectorXd other = state_, next, expected;
  for (const Index place : model_->unknown_places) other[place] *= 1.01;
  MatrixXd tangent, expected_tangent, jacobian, expected_jacobian;
  step_->linearised_transition(other, input_, expected, expected_tangent);
  step_->output_jacobian(other, input_, expected_jacobian);
  step_->linearised_transition(state_, input_, next, tangent);
  step_->output_jacobian(state_, input_, jacobian);
  step_->linearised_transition(other, input_, next, tangent);
  step_->output_jacobian(other, input_, jacobian);
  EXPECT_EQ(next, expected);
  EXPECT_EQ(tangent, expected_tangent);
  EXPECT_EQ(jacobian, expected_jacobian);
}

INSTANTIATE_TEST_SUITE_P(EveryKind, OwnStep,
                         testing::Combine(testing::ValuesIn(cases()), testing::Values("exponential", "pade")),
                         [](const auto& tested) {
                           return std::get<0>(tested.param).name + "_" + std::get<1>(tested.param);
                         });

TEST(OwnStepOfTheBeam, StopsWhereAModeTurnsTooFar) {
  // Oracle: none needed; a step must end in numbers or in a reason.
  ModelSetting setting = test::beam_setting(test::steel_beam(0.36), 10, {{Quantity::displacement, 1.1}});
  setting.parameters = {test::parameter("tip_mass")};
  const auto model = model_registry().make("beam", {}, setting);
  const auto step = model->motion->structured(1e3, "exponential", {{}, MatrixXd::Identity(1, 1)});
  VectorXd state = VectorXd::Zero(static_cast<Index>(model->motion->state_labels().size())), next;
  EXPECT_THROW(step->transition(state, {}, next), std::runtime_error);
  state[model->unknown_places[0]] = -50.0;  // no mass matrix has this
  EXPECT_THROW(step->transition(state, {}, next), std::runtime_error);
}

}  // namespace
}  // namespace beamid::experiments::second_order_step_test
