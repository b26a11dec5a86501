// Models duffing, damped and bouc_wen against motions in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/models/joint_model.hpp"
#include "filters/discrete_model.hpp"
#include "tests/experiments/models/one_coordinate.hpp"

namespace beamid::experiments::nonlinear_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double mass = 3.0, stiffness = 515.8;

std::unique_ptr<JointModel> make(const std::string& name, const filters::Options& options) {
  return model_registry().make(name, options,
                               at_one_point(test::one_coordinate(mass, stiffness), {Quantity::displacement}));
}

VectorXd start(const JointModel& model, const std::vector<double>& parameters, double x) {
  VectorXd state = VectorXd::Zero(static_cast<Index>(model.motion->state_labels().size()));
  state[0] = x;
  for (std::size_t j = 0; j < parameters.size(); ++j) state[model.unknown_places[j]] = parameters[j];
  return state;
}

// States at steps of dt until the velocity changes its sign, that one included.
std::vector<VectorXd> until_reversal(const JointModel& model, VectorXd state, double dt) {
  const auto step = filters::discretise(model.motion, dt, "runge_kutta_4", {{}, MatrixXd::Identity(1, 1)});
  std::vector<VectorXd> path{state};
  VectorXd next;
  do {
    step->transition(state, {}, next);
    state.swap(next);
    path.push_back(state);
  } while (path.size() < 100000 && (path.size() < 4 || path.back()[1] * path[path.size() - 2][1] > 0.0));
  return path;
}

// Where the velocity vanishes, between the last two states.
double turning_time(const std::vector<VectorXd>& path, double dt) {
  const double before = path[path.size() - 2][1], after = path.back()[1];
  return dt * (static_cast<double>(path.size() - 2) + before / (before - after));
}
double turning_place(const std::vector<VectorXd>& path) {
  const VectorXd &before = path[path.size() - 2], &after = path.back();
  const double part = before[1] / (before[1] - after[1]);
  return before[0] + part * 0.5 * (after[0] - before[0]) / std::max(part, 1.0 - part);
}

TEST(Duffing, HasTheFrequencyOfItsAmplitude) {
  // Oracle: half a period of the undamped Duffing oscillator is 2 K(k) / sqrt(w0^2 + e a^2),
  // k^2 = e a^2 / 2 / (w0^2 + e a^2), by the complete elliptic integral [kovacic2011].
  const auto model = make("duffing", {});
  const double a = 0.08, cubic = 4e4, dt = 1e-3;
  const double square = (stiffness + cubic * a * a) / mass;
  const double k = std::sqrt(0.5 * cubic * a * a / mass / square);
  const auto path = until_reversal(*model, start(*model, {stiffness, 0.0, cubic}, a), dt);
  EXPECT_NEAR(turning_time(path, dt), 2.0 * std::comp_ellint_1(k) / std::sqrt(square), 1e-6);
  EXPECT_GT(std::abs(turning_time(path, dt) / (std::numbers::pi * std::sqrt(mass / stiffness)) - 1.0), 0.1);
}

TEST(Damped, LosesTwiceTheFrictionOverTheStiffnessInHalfACycle) {
  // Oracle: under dry friction alone the amplitude falls by 2 F_c / K in every half cycle.
  const auto model = make("damped", {{"friction_velocity_m_per_s", 1e-5}});
  const double a = 0.02, friction = 0.5;
  const auto path = until_reversal(*model, start(*model, {stiffness, 0.0, friction, 0.0}, a), 1e-5);
  EXPECT_NEAR(-turning_place(path), a - 2.0 * friction / stiffness, 2e-6);
}

TEST(Damped, LosesBySquaredVelocityAsTheEnergyEquationSays) {
  // Oracle: (1 + u a1) e^(-u a1) = (1 - u a2) e^(u a2), u = 2 c_2 / M: the linear equation of v^2 along x.
  const auto model = make("damped", {});
  const double a1 = 0.05, quadratic = 4.0, u = 2.0 * quadratic / mass;
  const auto path = until_reversal(*model, start(*model, {stiffness, 0.0, 0.0, quadratic}, a1), 1e-4);
  const double a2 = -turning_place(path);
  EXPECT_NEAR((1.0 + u * a1) * std::exp(-u * a1), (1.0 - u * a2) * std::exp(u * a2), 1e-7);
  EXPECT_LT(a2, 0.95 * a1);
}

TEST(BoucWen, YieldsExponentiallyUnderMonotonicMotion) {
  // Oracle: dh/dx = 1 - (beta + gamma) h on the first loading, h = (1 - e^(-(beta + gamma) x)) / (beta +
  // gamma); here away from x = a, on unloading from h = 0.
  const auto model = make("bouc_wen", {});
  const double a = 0.05, beta = 12.0, gamma = 6.0;
  VectorXd state = start(*model, {stiffness, 0.0, 0.4, beta, gamma}, a);
  state[2] = a;  // all of it slipped: h = 0
  const auto path = until_reversal(*model, state, 1e-4);
  const VectorXd& end = path[path.size() - 2];
  const double moved = a - end[0], h = end[0] - end[2];
  EXPECT_NEAR(-h, (1.0 - std::exp(-(beta + gamma) * moved)) / (beta + gamma), 1e-9);
  EXPECT_GT(moved, 0.04);
}

TEST(NonlinearModels, FixWhatParametersDoNotName) {
  // Oracle: with [[parameters]] only what they name is asked about beside stiffness and damping; the rest is
  // the option's value.
  ModelSetting setting = at_one_point(test::one_coordinate(mass, stiffness), {Quantity::displacement});
  ParameterChoice friction;
  friction.quantity = "coulomb_friction";
  setting.parameters = {friction};
  const auto model = model_registry().make("damped", {{"quadratic_damping_n_s2_per_m2", 7.0}}, setting);
  ASSERT_EQ(model->unknowns.size(), 3u);
  VectorXd state = VectorXd::Zero(5), rate;
  state[1] = 2.0;
  model->motion->rate(state, {}, rate);
  EXPECT_NEAR(rate[1], -7.0 * 4.0 / mass, 1e-12);
  setting.parameters.push_back(friction);
  EXPECT_THROW(model_registry().make("damped", {}, setting), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::nonlinear_test
