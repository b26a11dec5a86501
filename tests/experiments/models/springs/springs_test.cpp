// Every registered spring law keeps the contracts that users hold theirs to. A new one is found by itself.
#include <gtest/gtest.h>

#include "beamid/testing/spring_contracts.hpp"

namespace beamid::test {
INSTANTIATE_TEST_SUITE_P(Registered, EverySpringLaw,
                         testing::ValuesIn(names_in(experiments::spring_law_registry())), by_name);
}  // namespace beamid::test

namespace beamid::experiments::springs_test {
namespace {

TEST(Hyperbolic, HasLostHalfItsStiffnessAtTheReferenceDrift) {
  // Oracle: the secant k / (1 + |d| / d_r) [hardin1972].
  const auto law = spring_law_registry().make("hyperbolic", {{"reference_drift_m", 0.02}});
  const SpringVector p = spring_parameters(*law, 500.0);
  SpringForce force(p.size());
  law->evaluate(-0.02, 0.0, 0.0, p, force);
  EXPECT_NEAR(force.value, -500.0 * 0.02 / 2.0, 1e-12);
  EXPECT_THROW(spring_law_registry().make("hyperbolic", {{"reference_drift_m", 0.0}}), std::invalid_argument);
}

TEST(BoucWenSpring, RefusesExponentsBelowOne) {
  EXPECT_THROW(spring_law_registry().make("bouc_wen", {{"exponent", 0.5}}), std::invalid_argument);
  EXPECT_THROW(spring_law_registry().make("bouc_wen", {{"reference_length_m", 0.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::springs_test
