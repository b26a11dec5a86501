// Discretisations: those of the registry keep the contracts that users hold theirs to; orders, closed forms,
// refusals.
#include "filters/scheme.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "beamid/testing/scheme_contracts.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::test {
INSTANTIATE_TEST_SUITE_P(Registered, EveryScheme, testing::ValuesIn(names_in(filters::scheme_registry())),
                         by_name);
}  // namespace beamid::test

namespace beamid::scheme_test {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using filters::scheme_registry;

const VectorXd no_input;

TEST(Schemes, ConvergeAtTheirOrder) {
  // Oracle: the exact exponential; halving the step divides the error over 1 s by 2^order.
  const std::pair<const char*, int> orders[] = {{"forward_euler", 1},     {"backward_euler", 1},
                                                {"implicit_midpoint", 2}, {"runge_kutta_2", 2},
                                                {"runge_kutta_4", 4},     {"pade", 4}};
  const test::Oscillator model(3.0);
  const auto end = [&](const char* name, int steps) {
    const auto scheme = scheme_registry().make(name, {});
    VectorXd z(4), next;
    z << 0.012, 0.0, 515.8, 8.0;
    for (int k = 0; k < steps; ++k) {
      scheme->step(model, z, no_input, 1.0 / steps, next, nullptr);
      z.swap(next);
    }
    return z;
  };
  const VectorXd exact = end("exponential", 1);
  for (const auto& [name, order] : orders) {
    const double coarse = (end(name, 1000) - exact).norm(), fine = (end(name, 2000) - exact).norm();
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.05) << name;
  }
}

TEST(Exponential, MovesUnderHeldForceAsTheClosedFormSays) {
  // Oracle: response of a damped oscillator to a step force from rest, F/K (1 - e^(-s t)(cos wd t + s/wd sin
  // wd t)).
  const double mass = 3.0, stiffness = 515.8, damping = 8.0, force = 25.0, t = 0.37;
  const test::Oscillator model(mass, 1, true);
  VectorXd z(4), next;
  z << 0.0, 0.0, stiffness, damping;
  scheme_registry().make("exponential", {})->step(model, z, VectorXd::Constant(1, force), t, next, nullptr);
  const double s = damping / (2 * mass), wd = std::sqrt(stiffness / mass - s * s);
  const double expected =
      force / stiffness * (1 - std::exp(-s * t) * (std::cos(wd * t) + s / wd * std::sin(wd * t)));
  EXPECT_NEAR(next[0], expected, 1e-15);
}

TEST(Exponential, IsOneCaseThroughCriticalDamping) {
  // Oracle: CVODES at 1e-12, on both sides of critical damping and at it.
  const auto exact = scheme_registry().make("exponential", {}),
             adaptive = scheme_registry().make("cvode", {});
  const test::Oscillator model(3.0);
  const double critical = 2.0 * std::sqrt(3.0 * 515.8);
  for (const double ratio : {0.0, 0.01, 0.999999, 1.0, 1.000001, 1.5, 4.0}) {
    VectorXd z(4), next, other;
    MatrixXd tangent, other_tangent;
    z << 0.012, -0.2, 515.8, ratio * critical;
    exact->step(model, z, no_input, 0.05, next, &tangent);
    adaptive->step(model, z, no_input, 0.05, other, &other_tangent);
    EXPECT_LT((next - other).head(2).norm(), 1e-10) << ratio;
    EXPECT_LT((tangent - other_tangent).cwiseAbs().maxCoeff(), 1e-9) << ratio;
  }
}

TEST(Discretise, RefusesWhatCannotBe) {
  const auto model = std::make_shared<test::Oscillator>(3.0);
  const MatrixXd one = MatrixXd::Identity(1, 1);
  EXPECT_THROW(filters::discretise(model, 0.0, "exponential", {{}, one}), std::invalid_argument);
  EXPECT_THROW(filters::discretise(model, 1e-3, "euler", {{}, one}), std::invalid_argument);
  EXPECT_THROW(filters::discretise(model, 1e-3, "exponential", {{}, MatrixXd::Identity(2, 2)}),
               std::invalid_argument);
}

}  // namespace
}  // namespace beamid::scheme_test
