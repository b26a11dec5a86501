// Conformance of discretisations: each against its own stability function, differences and the exact motion.
// To be included by one file of a test program, which says what it runs on, in namespace beamid::test:
//
//     INSTANTIATE_TEST_SUITE_P(Mine, EveryScheme, testing::Values("my_scheme"), by_name);
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <stdexcept>
#include <string>

#include "beamid/testing/named.hpp"
#include "beamid/testing/oscillator.hpp"
#include "filters/central_differences.hpp"
#include "filters/scheme.hpp"

namespace beamid::test {

/// The suite, on a registered name.
class EveryScheme : public testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<filters::Scheme> scheme = filters::scheme_registry().make(GetParam(), {});

  /// Per step, of schemes that have an option of this name; else zero.
  static double own_tolerance() {
    const filters::Options options = filters::scheme_registry().completed(GetParam(), {});
    return options.values().contains("tolerance") ? options.number("tolerance") : 0.0;
  }
};

namespace scheme_contracts {

using Eigen::MatrixXd, Eigen::VectorXd;
using filters::scheme_registry;
using Complex = std::complex<double>;

TEST_P(EveryScheme, MultipliesAnEigenmotionByItsStabilityFunction) {
  // Oracle: the closed-form g of [hairer1996, ch. IV.3]: along the eigenvector of lambda, [1, lambda] -> g
  // [1, lambda].
  const double mass = 3.0, stiffness = 515.8, damping = 8.0, dt = 0.01;
  const Oscillator model(mass);
  const double decay = damping / (2 * mass);
  const Complex lambda(-decay, std::sqrt(stiffness / mass - decay * decay));
  const Complex expected = scheme->amplification(lambda * dt).value;
  Complex moved[2];
  for (int part = 0; part < 2; ++part) {  // the real and the imaginary part of [1, lambda]
    VectorXd z(4), next;
    z << (part == 0 ? 1.0 : 0.0), (part == 0 ? lambda.real() : lambda.imag()), stiffness, damping;
    scheme->step(model, z, VectorXd(), dt, next, nullptr);
    for (int i = 0; i < 2; ++i) moved[i] += next[i] * (part == 0 ? Complex(1, 0) : Complex(0, 1));
    EXPECT_EQ(next[2], stiffness);
    EXPECT_EQ(next[3], damping);
  }
  const double tolerance = std::max(1e-14, 100.0 * own_tolerance());
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
    const Oscillator model(3.0, 1, forced);
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

TEST_P(EveryScheme, DescribesItselfAndItsOptions) {
  expect_described(scheme_registry().find(GetParam()));
}

}  // namespace scheme_contracts
}  // namespace beamid::test
