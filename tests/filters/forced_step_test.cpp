// Steps under inputs that are polynomials of the step.
#include <gtest/gtest.h>

#include <cmath>

#include "beamid/testing/oscillator.hpp"
#include "filters/central_differences.hpp"
#include "filters/scheme.hpp"
#include "filters/step_input.hpp"

namespace beamid::forced_step_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::scheme_registry;

const VectorXd start = (VectorXd(4) << 0.012, -0.3, 515.8, 8.0).finished();
const VectorXd bent = (VectorXd(5) << 25.0, -31.0, 14.0, 9.0, -6.0).finished();

class EveryForcedScheme : public testing::TestWithParam<std::string> {};

TEST_P(EveryForcedScheme, HasTheTangentOfItsStep) {
  // Oracle: central differences.
  const test::Oscillator model(3.0, 1, true);
  const auto scheme = scheme_registry().make(GetParam(), {});
  VectorXd next;
  MatrixXd tangent, difference;
  scheme->step(model, start, bent, 0.01, next, &tangent);
  const auto step = [&](const VectorXd& at, VectorXd& value) {
    scheme->step(model, at, bent, 0.01, value, nullptr);
  };
  filters::central_differences(step, start, 4, difference);
  EXPECT_LT((tangent - difference).cwiseAbs().maxCoeff(), 2e-8);
}

TEST_P(EveryForcedScheme, ConvergesAtItsOrderUnderTheForce) {
  // Oracle: the exact step over 0.2 s; twice the steps divide the error by 2^order.
  const test::Oscillator model(3.0, 1, true);
  const auto end = [&](const std::string& name, int steps) {
    const auto scheme = scheme_registry().make(name, {});
    MatrixXd columns(5, 2);
    columns << bent, bent;
    const filters::InputPaths parts = filters::in_parts({columns, 4}, steps);
    VectorXd z = start, next;
    for (Index k = 0; k < steps; ++k) {
      scheme->step(model, z, parts.columns.col(k), 0.2 / steps, next, nullptr);
      z.swap(next);
    }
    return z;
  };
  const VectorXd exact = end("exponential", 1);
  const std::map<std::string, int> orders{
      {"forward_euler", 1}, {"backward_euler", 1}, {"implicit_midpoint", 2},        {"runge_kutta_2", 2},
      {"runge_kutta_4", 4}, {"pade", 4},           {"runge_kutta_4_differences", 4}};
  const auto found = orders.find(GetParam());
  if (found == orders.end()) {
    EXPECT_LT((end(GetParam(), 3) - exact).norm(), 1e-10);
    return;
  }
  const int steps = found->second == 4 ? 20 : 400;
  const double coarse = (end(GetParam(), steps) - exact).norm(),
               fine = (end(GetParam(), 2 * steps) - exact).norm();
  EXPECT_NEAR(std::log2(coarse / fine), found->second, 0.1);
}

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const auto& [name, entry] : scheme_registry().entries()) result.push_back(name);
  return result;
}
INSTANTIATE_TEST_SUITE_P(Registered, EveryForcedScheme, testing::ValuesIn(names()),
                         [](const auto& tested) { return tested.param; });

// The oscillator with a third, idle coordinate: it takes the general exponential.
class Idle final : public filters::LinearMotion {
 public:
  Index input_size() const override { return 2; }
  std::vector<filters::Label> state_labels() const override {
    return {{"x", "m"}, {"v", "m/s"}, {"idle", ""}, {"K", "N/m"}, {"C", "N s/m"}, {"1/M", "1/kg"}};
  }
  std::vector<filters::Label> output_labels() const override { return {{"x", "m"}}; }
  Index motion_size() const override { return 3; }
  Index parameter_size() const override { return 3; }
  void motion_matrix(const VectorXd& z, MatrixXd& a) const override {
    a.setZero(3, 3);
    a.topRows(2) << 0.0, 1.0, 0.0, -z[3] * z[5], -z[4] * z[5], 0.0;
  }
  void motion_matrix_derivative(const VectorXd& z, Index j, MatrixXd& a) const override {
    a.setZero(3, 3);
    if (j < 2) a(1, j) = -z[5];
    if (j == 2) a.row(1) << -z[3], -z[4], 0.0;
  }
  void input_matrix(const VectorXd& z, MatrixXd& b) const override {
    b.setZero(3, 2);
    b.row(1) << z[5], -2.0 * z[5];
  }
  void input_matrix_derivative(const VectorXd&, Index j, MatrixXd& b) const override {
    b.setZero(3, 2);
    if (j == 2) b.row(1) << 1.0, -2.0;
  }
  void output(const VectorXd& z, const VectorXd&, VectorXd& y) const override { y = z.head(1); }
};

TEST(ForcedExponential, IsTheMotionUnderTheForceForShortAndLongSteps) {
  // Oracle: CVODES at 1e-12, the tangent by its sensitivities. At 0.4 s the oscillator turns by 5 rad.
  const Idle model;
  VectorXd z(6), path(10), next, expected;
  z << 0.012, -0.3, 0.7, 515.8, 8.0, 1.0 / 3.0;
  path << 25.0, 1.0, -31.0, 2.0, 14.0, 3.0, 9.0, -4.0, -6.0, 5.0;
  MatrixXd tangent, expected_tangent;
  for (const double dt : {1e-3, 0.05, 0.4}) {
    scheme_registry().make("exponential", {})->step(model, z, path, dt, next, &tangent);
    scheme_registry().make("cvode", {})->step(model, z, path, dt, expected, &expected_tangent);
    EXPECT_LT((next - expected).cwiseAbs().maxCoeff(), 1e-9) << dt;
    EXPECT_LT((tangent - expected_tangent).cwiseAbs().maxCoeff(), 1e-7) << dt;
  }
}

TEST(ForcedExponential, IsOneCaseForTwoCoordinatesAndMore) {
  // Oracle: the general exponential, of which the oscillator's own is another way.
  const Idle general;
  const test::Oscillator model(3.0, 1, true);
  VectorXd z(6), path(10), next, expected;
  z << start.head(2), 0.7, start.tail(2), 1.0 / 3.0;
  for (Index j = 0; j < 5; ++j) path.segment(2 * j, 2) << bent[j], 0.0;
  MatrixXd tangent, expected_tangent;
  for (const double dt : {1e-4, 0.01, 0.1, 0.2, 0.25}) {
    scheme_registry().make("exponential", {})->step(model, start, bent, dt, next, &tangent);
    scheme_registry().make("exponential", {})->step(general, z, path, dt, expected, &expected_tangent);
    EXPECT_LT((next.head(2) - expected.head(2)).norm(), 1e-13) << dt;
    EXPECT_LT((tangent.topRightCorner(2, 2) - expected_tangent.block(0, 3, 2, 2)).norm(), 1e-13) << dt;
  }
}

TEST(ForcedPade, MovesAPolynomialMotionExactly) {
  // Oracle: x = s^4 + 1 is the motion under the force M x'' + C x' + K x.
  const double mass = 3.0, k = 515.8, c = 8.0, dt = 0.3;
  const test::Oscillator model(mass, 1, true);
  const double m = mass / (dt * dt), d = c / dt;
  VectorXd path(5), z(4), next;
  path << k, 0.0, 12.0 * m, 4.0 * d, k;
  z << 1.0, 0.0, k, c;
  scheme_registry().make("pade", {})->step(model, z, path, dt, next, nullptr);
  EXPECT_NEAR(next[0], 2.0, 1e-13);
  EXPECT_NEAR(next[1], 4.0 / dt, 1e-12);
}

}  // namespace
}  // namespace beamid::forced_step_test
