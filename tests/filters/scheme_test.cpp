// Conformance: every registered discretisation against its own stability function, differences and the exact
// motion.
#include "filters/scheme.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "filters/central_differences.hpp"
#include "filters/discrete_model.hpp"
#include "tests/filters/oscillator.hpp"

namespace beamid::scheme_test {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using filters::scheme_registry;
using Complex = std::complex<double>;

const VectorXd no_input;

class EveryScheme : public testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<filters::Scheme> scheme = scheme_registry().make(GetParam(), {});
};

TEST_P(EveryScheme, MultipliesAnEigenmotionByItsStabilityFunction) {
  // Oracle: the closed-form g of [hairer1996, ch. IV.3]: along the eigenvector of lambda, [1, lambda] -> g
  // [1, lambda].
  const double mass = 3.0, stiffness = 515.8, damping = 8.0, dt = 0.01;
  const test::Oscillator model(mass);
  const double decay = damping / (2 * mass);
  const Complex lambda(-decay, std::sqrt(stiffness / mass - decay * decay));
  const Complex expected = scheme->amplification(lambda * dt).value;
  Complex moved[2];
  for (int part = 0; part < 2; ++part) {  // the real and the imaginary part of [1, lambda]
    VectorXd z(4), next;
    z << (part == 0 ? 1.0 : 0.0), (part == 0 ? lambda.real() : lambda.imag()), stiffness, damping;
    scheme->step(model, z, no_input, dt, next, nullptr);
    for (int i = 0; i < 2; ++i) moved[i] += next[i] * (part == 0 ? Complex(1, 0) : Complex(0, 1));
    EXPECT_EQ(next[2], stiffness);
    EXPECT_EQ(next[3], damping);
  }
  const double tolerance = GetParam() == "cvode" ? 1e-10 : 1e-14;
  EXPECT_LT(std::abs(moved[0] - expected), tolerance);
  EXPECT_LT(std::abs(moved[1] - lambda * expected), tolerance * std::abs(lambda));
}

TEST_P(EveryScheme, StabilityFunctionHasItsDerivative) {
  const Complex z(-0.1, 0.3), h(1e-6, 0.0);
  const Complex slope = (scheme->amplification(z + h).value - scheme->amplification(z - h).value) / (2.0 * h);
  EXPECT_LT(std::abs(slope - scheme->amplification(z).derivative), 1e-9);
}

TEST_P(EveryScheme, TangentIsTheDerivativeOfTheStep) {
  // Oracle: central differences of the step itself, with and without an input.
  for (const bool forced : {false, true}) {
    const test::Oscillator model(3.0, 1, forced);
    const VectorXd input = VectorXd::Constant(forced ? 1 : 0, 25.0);
    VectorXd z(4), next;
    z << 0.012, -0.3, 515.8, 8.0;
    MatrixXd tangent, difference;
    scheme->step(model, z, input, 0.01, next, &tangent);
    const auto step = [&](const VectorXd& at, VectorXd& value) {
      scheme->step(model, at, input, 0.01, value, nullptr);
    };
    filters::central_differences(step, z, 4, difference);
    EXPECT_LT((tangent - difference).cwiseAbs().maxCoeff(), 2e-8) << (forced ? "forced" : "free");
  }
}

TEST_P(EveryScheme, SeesThroughItsOwnStabilityFunction) {
  // Oracle: applying g to what was seen through g gives the motion back.
  const Complex mu(-1.3, 13.0);
  const Complex seen = filters::seen_through(*scheme, mu, 1e-3);
  EXPECT_LT(std::abs(scheme->amplification(seen * 1e-3).value - std::exp(mu * 1e-3)), 1e-15);
  EXPECT_LT(std::abs(seen - mu), 0.2);  // on the branch that tends to mu
}

TEST_P(EveryScheme, RejectsUnknownOptions) {
  EXPECT_THROW(scheme_registry().make(GetParam(), {{"no_such_option", 1.0}}), std::invalid_argument);
}

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const auto& [name, entry] : scheme_registry().entries()) result.push_back(name);
  return result;
}
INSTANTIATE_TEST_SUITE_P(Registered, EveryScheme, testing::ValuesIn(names()),
                         [](const auto& tested) { return tested.param; });

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
