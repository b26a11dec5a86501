// Chains whose storeys follow laws. Oracles: models of one coordinate, equations written out by hand and
// moved by SUNDIALS, central differences.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "experiments/models/joint_model.hpp"
#include "experiments/models/springs/spring_law.hpp"
#include "experiments/models/storeys.hpp"
#include "fem/shear_building.hpp"
#include "filters/central_differences.hpp"
#include "filters/discrete_model.hpp"
#include "tests/experiments/models/storey_setting.hpp"

namespace beamid::experiments::storeys_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using test::asked, test::bouc_wen, test::setting_of, test::spring, test::three;

// Somewhere, the unknowns 10 % off their guesses.
VectorXd state_of(const JointModel& model) {
  const auto size = static_cast<Index>(model.motion->state_labels().size());
  VectorXd state(size);
  for (Index i = 0; i < size; ++i) state[i] = 0.02 * std::sin(1.0 + 1.7 * static_cast<double>(i));
  for (std::size_t j = 0; j < model.unknowns.size(); ++j)
    state[model.unknown_places[j]] = model.unknowns[j].to_state(1.1 * model.unknowns[j].guess);
  return state;
}

// All that can be asked about, of every law. Oracle: central differences of rate, reading and step.
TEST(Storeys, HaveExactTangents) {
  ModelSetting setting = setting_of(three, {spring(1, "bouc_wen", bouc_wen), spring(2, "hyperbolic", {}),
                                            spring(3, "duffing", {{"cubic_stiffness_n_per_m3", 5.0e7}})});
  setting.damping = fem::ModalDamping{{0.02}};
  for (const char* const quantity : {"hysteresis_gamma", "tip_mass", "cubic_stiffness", "post_yield_ratio",
                                     "reference_drift", "storey_damping", "damping_ratio", "hysteresis_beta"})
    setting.parameters.push_back(asked(quantity));
  setting.parameters.push_back(asked("storey_stiffness", std::pair{0.0, 3.0}));
  setting.parameters.push_back(asked("storey_stiffness", std::pair{3.0, 9.0}));
  setting.parameters[2].form = Form::logarithmic;
  setting.parameters[8].form = Form::logarithmic;
  for (const bool drift : {false, true}) {
    const auto model = model_registry().make("beam", {{"sensor_drift", drift}}, setting);
    const VectorXd state = state_of(*model);
    const Eigen::Vector2d input(130.0, 0.7);
    const auto near = [](const MatrixXd& given, const MatrixXd& difference) {
      ASSERT_EQ(given.cols(), difference.cols());
      for (Index j = 0; j < given.cols(); ++j)
        EXPECT_LE((given.col(j) - difference.col(j)).norm(), 2e-6 * difference.col(j).norm()) << j;
    };
    MatrixXd given, difference;
    model->motion->rate_jacobian(state, input, given);
    filters::central_differences(
        [&](const VectorXd& z, VectorXd& value) { model->motion->rate(z, input, value); }, state,
        state.size(), difference);
    near(given, difference);
    model->motion->output_jacobian(state, input, given);
    filters::central_differences(
        [&](const VectorXd& z, VectorXd& value) { model->motion->output(z, input, value); }, state, 9,
        difference);
    near(given, difference);
    const auto step =
        filters::discretise(model->motion, 0.02, "runge_kutta_4", {{}, MatrixXd::Identity(9, 9)});
    Eigen::Vector4d path(130.0, 0.7, -40.0, 0.3);
    VectorXd next, moved;
    step->linearised_transition(state, path, next, given);
    filters::central_differences(
        [&](const VectorXd& z, VectorXd& value) { step->transition(z, path, value); }, state, state.size(),
        difference);
    near(given, difference);
    MatrixXd directions = MatrixXd::Random(state.size(), 3);
    const MatrixXd expected = given * directions;
    step->move(state, path, moved, directions);
    EXPECT_EQ(moved, next);
    EXPECT_LE((directions - expected).norm(), 1e-12 * expected.norm());
  }
}

// The building above as a page of equations.
class ByHand final : public filters::ContinuousModel {
 public:
  Index input_size() const override { return 2; }
  std::vector<filters::Label> state_labels() const override {
    return std::vector<filters::Label>(7, {"z", "1"});
  }
  std::vector<filters::Label> output_labels() const override { return {{"y", "1"}}; }
  void rate(const VectorXd& z, const VectorXd& u, VectorXd& rate) const override {
    const double d1 = z[0], d2 = z[1] - z[0], d3 = z[2] - z[1], v1 = z[3], v2 = z[4] - z[3], v3 = z[5] - z[4];
    const double h = z[6];
    const double f1 = 0.3 * 4.0e5 * d1 + 0.7 * 4.0e5 * h + 800 * v1,
                 f2 = 3.2e5 * d2 / (1 + std::abs(d2) / 0.01) + 640 * v2,
                 f3 = 2.4e5 * d3 + 5.0e7 * d3 * d3 * d3 + 480 * v3;
    rate.resize(7);
    rate << z[3], z[4], z[5], (f2 - f1) / 1000 - u[1], (f3 - f2) / 900 - u[1], (u[0] - f3) / 800 - u[1],
        v1 - (60.0 * std::abs(v1) * h + 25.0 * v1 * std::abs(h));
  }
  void output(const VectorXd&, const VectorXd&, VectorXd& output) const override { output.setZero(1); }
};

// Oracle: the same equations by hand, moved by CVODES to 1e-12. The step's own error falls as its fourth
// power where the motion has no corner, and is below 1e-8 of the motion at 0.2 ms.
TEST(Storeys, MoveAsTheirEquationsSay) {
  ModelSetting setting = setting_of(three, {spring(1, "bouc_wen", bouc_wen), spring(2, "hyperbolic", {}),
                                            spring(3, "duffing", {{"cubic_stiffness_n_per_m3", 5.0e7}})});
  setting.parameters = {asked("storey_stiffness")};
  const auto model = model_registry().make("beam", {{"sensor_bias", false}}, setting);
  const double dt = 0.002;
  const auto exact =
      filters::discretise(std::make_shared<ByHand>(), dt, "cvode", {{}, MatrixXd::Identity(1, 1)});
  const auto adaptive = filters::discretise(model->motion, dt, "cvode", {{}, MatrixXd::Identity(9, 9)});
  const auto stepped =
      filters::discretise(model->motion, dt / 10, "runge_kutta_4", {{}, MatrixXd::Identity(9, 9)});
  VectorXd by_hand = VectorXd::Zero(7), a = VectorXd::Zero(8), b, next;
  a[model->unknown_places[0]] = model->unknowns[0].guess;
  b = a;
  const auto input = [](double t) {
    return Eigen::Vector2d(900.0 * std::sin(7.0 * t), 2.0 * std::sin(8.0 * t));
  };
  const auto path = [&](double t, double length) {
    Eigen::Vector4d p;
    p << input(t), input(t + length) - input(t);
    return VectorXd(p);
  };
  double largest = 0.0, slipped = 0.0, apart = 0.0, step_error = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const double t = dt * k;
    const VectorXd whole = path(t, dt);
    exact->transition(by_hand, whole, next), by_hand.swap(next);
    adaptive->transition(a, whole, next), a.swap(next);
    for (int i = 0; i < 10; ++i) {
      const double part = 0.1 * i;
      VectorXd piece(4);
      piece << whole.head(2) + part * whole.tail(2), 0.1 * whole.tail(2);
      stepped->transition(b, piece, next), b.swap(next);
    }
    largest = std::max(largest, by_hand.head(3).cwiseAbs().maxCoeff());
    slipped = std::max(slipped, std::abs(by_hand[0] - by_hand[6]));
    apart = std::max({apart, (a.head(3) - by_hand.head(3)).cwiseAbs().maxCoeff(),
                      std::abs(a[model->slips[0]] - (by_hand[0] - by_hand[6]))});
    step_error = std::max(step_error, (b.head(3) - by_hand.head(3)).cwiseAbs().maxCoeff());
  }
  EXPECT_GT(largest, 0.02);  // a motion that has left the linear one
  EXPECT_GT(slipped, 0.005);
  EXPECT_LT(apart, 1e-8 * largest);
  EXPECT_LT(step_error, 1e-7 * largest);
}

TEST(Storeys, AskAboutTheirLawsByThemselves) {
  const ModelSetting setting = setting_of(
      three, {spring(1, "bouc_wen", bouc_wen), spring(3, "duffing", {{"cubic_stiffness_n_per_m3", 5e7}})});
  std::vector<std::string> names;
  const auto model = model_registry().make("beam", {}, setting);
  for (const Unknown& unknown : model->unknowns) names.push_back(unknown.name);
  EXPECT_THAT(names, testing::ElementsAre("storey_stiffness", "damping_ratio", "post_yield_ratio",
                                          "hysteresis_beta", "hysteresis_gamma", "cubic_stiffness"));
  EXPECT_EQ(model->unknowns[5].guess, 5e7);
}

// Oracle: the storeys that lie in a region; those that share a parameter have one value.
TEST(Storeys, ShareParametersOfTheirRegion) {
  const std::vector<StoreySpring> springs{spring(1, "duffing", {{"cubic_stiffness_n_per_m3", 1e7}}),
                                          spring(2, "duffing", {{"cubic_stiffness_n_per_m3", 1e7}}),
                                          spring(3, "duffing", {{"cubic_stiffness_n_per_m3", 3e7}})};
  const fem::Beam chain = fem::shear_building(three);
  EXPECT_EQ(law_value(chain, springs, "cubic_stiffness", std::pair{0.0, 6.0}), 1e7);
  EXPECT_EQ(law_value(chain, springs, "cubic_stiffness", std::pair{6.0, 9.0}), 3e7);
  EXPECT_FALSE(law_value(chain, springs, "cubic_stiffness", {}));
  EXPECT_FALSE(law_value(chain, springs, "reference_drift", {}));
  const auto message = [&](const ParameterChoice& choice) -> std::string {
    ModelSetting setting = setting_of(three, springs);
    setting.parameters = {choice};
    try {
      model_registry().make("beam", {}, setting);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "made";
  };
  using testing::HasSubstr;
  EXPECT_EQ(message(asked("cubic_stiffness", std::pair{0.0, 6.0})), "made");
  EXPECT_THAT(message(asked("cubic_stiffness")), HasSubstr("several values of it"));
  EXPECT_THAT(message(asked("reference_drift", std::pair{0.0, 3.0})),
              HasSubstr("no storey between 0 and 3 m has a law with reference_drift"));
  EXPECT_THAT(message(asked("frequency")), HasSubstr("has no parameter 'frequency'"));
}

TEST(Storeys, AreNeitherReducedNorCut) {
  ModelSetting setting = setting_of(three, {spring(1, "duffing", {{"cubic_stiffness_n_per_m3", 1e7}})});
  setting.reduction = reduction::reduction_registry().make("modal_truncation", {{"modes", 2.0}});
  EXPECT_THROW(model_registry().make("beam", {}, setting), std::invalid_argument);
  setting.reduction = reduction::reduction_registry().make("none", {});
  EXPECT_NO_THROW(model_registry().make("beam", {}, setting));
  setting.supports = {0};
  EXPECT_THROW(model_registry().make("beam", {}, setting), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::storeys_test
