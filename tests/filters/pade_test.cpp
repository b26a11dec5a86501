// The (2,2) Pade step: its bias, its linear path against the Gauss method, motion under force.
#include <gtest/gtest.h>

#include <cmath>

#include "beamid/testing/oscillator.hpp"
#include "filters/central_differences.hpp"
#include "filters/scheme.hpp"

namespace beamid::pade_test {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using filters::scheme_registry;
using Complex = std::complex<double>;

TEST(Pade, SeesFrequenciesTooHighByTheFourthPowerOfTheStepOver720) {
  // Oracle: the phase of R(iy) is 2 atan(6y/(12 - y^2)) = y - y^5/720 + ..., so the frequency seen through it
  // is w (1 + (w dt)^4/720 - (w dt)^6/12096): 6.3e-10 of it at w dt = 0.026, S(0.65) at 1 kHz.
  const auto scheme = scheme_registry().make("pade", {});
  const double dt = 1e-3;
  for (const double y : {0.026, 0.1, 0.3}) {
    const Complex seen = filters::seen_through(*scheme, Complex(0.0, y / dt), dt);
    const double bias = seen.imag() * dt / y - 1.0;
    const double leading = std::pow(y, 4) / 720.0;
    EXPECT_NEAR(bias, leading - std::pow(y, 6) / 12096.0, 0.01 * std::pow(y, 4) * leading + 1e-14) << y;
    EXPECT_NEAR(bias / leading, 1.0, 0.06 * y * y + 2e-5) << y;  // rounding: 1e-14 beside 6.3e-10
    EXPECT_LT(std::abs(seen.real()) * dt, 1e-15);
  }
  const Complex decaying(-0.002 * 26.0, 26.0);  // both parts: lambda^5 dt^4/720
  const Complex seen = filters::seen_through(*scheme, decaying, dt);
  EXPECT_LT(std::abs(seen - decaying - std::pow(decaying, 5) * std::pow(dt, 4) / 720.0), 1e-12);
}

TEST(Pade, KeepsTheEnergyOfAnUndampedMotionForAnyStep) {
  // Oracle: |R(iy)| = 1; and A-stability, |R(z)| < 1 to the left of the imaginary axis.
  const auto scheme = scheme_registry().make("pade", {});
  for (const double y : {1e-3, 0.1, 3.0, 1e4})
    EXPECT_NEAR(std::abs(scheme->amplification({0.0, y}).value), 1.0, 1e-15);
  for (const double x : {-1e-3, -1.0, -1e3})
    for (const double y : {0.0, 0.1, 3.0, 100.0})
      EXPECT_LT(std::abs(scheme->amplification({x, y}).value), 1.0);
}

// The same oscillator, not known to be linear.
class Opaque final : public filters::ContinuousModel {
 public:
  explicit Opaque(const test::Oscillator& model) : model_(model) {}
  Eigen::Index input_size() const override { return model_.input_size(); }
  std::vector<filters::Label> state_labels() const override { return model_.state_labels(); }
  std::vector<filters::Label> output_labels() const override { return model_.output_labels(); }
  void rate(const VectorXd& z, const VectorXd& u, VectorXd& f) const override { model_.rate(z, u, f); }
  void rate_jacobian(const VectorXd& z, const VectorXd& u, MatrixXd& j) const override {
    model_.rate_jacobian(z, u, j);
  }
  void output(const VectorXd& z, const VectorXd& u, VectorXd& y) const override { model_.output(z, u, y); }

 private:
  const test::Oscillator& model_;
};

TEST(Pade, IsTheGaussMethodOnLinearMotion) {
  // Oracle: the collocation method of two stages by Newton's method, step and tangent, under a held force.
  const test::Oscillator linear(3.0, 1, true);
  const Opaque opaque(linear);
  const auto pade = scheme_registry().make("pade", {}), gauss = scheme_registry().make("pade", {});
  VectorXd z(4), next, other;
  MatrixXd tangent, other_tangent;
  z << 0.012, -0.3, 515.8, 8.0;
  for (const double dt : {1e-3, 0.1, 1.0}) {
    pade->step(linear, z, VectorXd::Constant(1, 25.0), dt, next, &tangent);
    gauss->step(opaque, z, VectorXd::Constant(1, 25.0), dt, other, &other_tangent);
    EXPECT_LT((next - other).norm(), 1e-13) << dt;
    EXPECT_LT((tangent - other_tangent).norm(), 1e-13 * tangent.norm()) << dt;
  }
}

// A pendulum, x'' = -9.81 sin x - p x', p unknown.
class Pendulum final : public filters::ContinuousModel {
 public:
  std::vector<filters::Label> state_labels() const override { return std::vector<filters::Label>(3); }
  std::vector<filters::Label> output_labels() const override { return std::vector<filters::Label>(1); }
  void rate(const VectorXd& z, const VectorXd&, VectorXd& f) const override {
    f = Eigen::Vector3d(z[1], -9.81 * std::sin(z[0]) - z[2] * z[1], 0.0);
  }
  void rate_jacobian(const VectorXd& z, const VectorXd&, MatrixXd& j) const override {
    j.setZero(3, 3);
    j(0, 1) = 1.0;
    j.row(1) << -9.81 * std::cos(z[0]), -z[2], -z[1];
  }
  void output(const VectorXd& z, const VectorXd&, VectorXd& y) const override { y = z.head(1); }
};

TEST(Pade, MovesNonlinearMotionAtOrderFourWithItsOwnTangent) {
  // Oracle: CVODES at 1e-12 for the motion, central differences of the step for the tangent.
  const Pendulum pendulum;
  const auto pade = scheme_registry().make("pade", {}), exact = scheme_registry().make("cvode", {});
  const VectorXd start = Eigen::Vector3d(2.0, 0.5, 0.1);
  VectorXd reference, next;
  exact->step(pendulum, start, {}, 1.0, reference, nullptr);
  double errors[2];
  for (const int halving : {0, 1}) {
    const int steps = 20 << halving;
    VectorXd z = start;
    for (int k = 0; k < steps; ++k) {
      pade->step(pendulum, z, {}, 1.0 / steps, next, nullptr);
      z.swap(next);
    }
    errors[halving] = (z - reference).norm();
  }
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 4.0, 0.1);
  MatrixXd tangent, difference;
  pade->step(pendulum, start, {}, 0.2, next, &tangent);
  const auto step = [&](const VectorXd& z, VectorXd& value) {
    pade->step(pendulum, z, {}, 0.2, value, nullptr);
  };
  filters::central_differences(step, start, 3, difference);
  EXPECT_LT((tangent - difference).norm(), 1e-8);
}

TEST(Pade, SaysThatNewtonsMethodDoesNotConverge) {
  // Oracle: not a number in, a message out.
  VectorXd next;
  EXPECT_THROW(scheme_registry()
                   .make("pade", {})
                   ->step(Pendulum(), VectorXd::Constant(3, std::nan("")), {}, 0.1, next, nullptr),
               std::runtime_error);
}

}  // namespace
}  // namespace beamid::pade_test
