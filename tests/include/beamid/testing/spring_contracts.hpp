// Conformance of spring laws: each keeps what chains and oscillators rely on. To be included by one file of a
// test program, which says what it runs on, in namespace beamid::test:
//
//     INSTANTIATE_TEST_SUITE_P(Mine, EverySpringLaw, testing::Values("my_law"), by_name);
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>

#include "beamid/testing/named.hpp"
#include "experiments/models/springs/spring_law.hpp"

namespace beamid::test {

/// The suite, on a registered name.
class EverySpringLaw : public testing::TestWithParam<std::string> {
 protected:
  static constexpr double stiffness = 900.0;  ///< [N/m]

  std::unique_ptr<experiments::SpringLaw> law = experiments::spring_law_registry().make(GetParam(), {});

  /// Parameters none of which is zero: those of the options, or 1 in their unit.
  experiments::SpringVector parameters() const {
    experiments::SpringVector p = experiments::spring_parameters(*law, stiffness);
    for (Eigen::Index i = 0; i < p.size(); ++i)
      if (p[i] == 0.0) p[i] = 1.0;
    return p;
  }
  experiments::SpringForce at(double drift, double rate, double slip,
                              const experiments::SpringVector& p) const {
    experiments::SpringForce force(p.size());
    law->evaluate(drift, rate, slip, p, force);
    return force;
  }
};

namespace spring_contracts {

using namespace experiments;
using Eigen::Index;

/// (f(x + h) - f(x - h)) / 2h of a force and of a slip's rate.
template <class Evaluate>
std::pair<double, double> differences(double size, const Evaluate& evaluate) {
  const double h = 1e-6 * size;
  const SpringForce above = evaluate(h), below = evaluate(-h);
  return {(above.value - below.value) / (2.0 * h), (above.slip_rate - below.slip_rate) / (2.0 * h)};
}

TEST_P(EverySpringLaw, HasTheStiffnessOfALinearSpringAtRest) {
  // Oracle: k, for whatever is asked of small motion is asked of the linear chain.
  const SpringVector p = parameters();
  const SpringForce rest = at(0.0, 0.0, 0.0, p);
  EXPECT_EQ(rest.value, 0.0);
  EXPECT_EQ(rest.slip_rate, 0.0);
  EXPECT_NEAR(rest.by_drift, stiffness, 1e-12 * stiffness);
  const double little = 1e-9;
  EXPECT_NEAR(at(little, 1e-9, 0.0, p).value, stiffness * little, 1e-6 * stiffness * little);
}

TEST_P(EverySpringLaw, GivesTheDerivativesOfItsForceAndSlip) {
  // Oracle: central differences, on either side of every corner.
  const SpringVector p = parameters();
  for (const double d : {-0.011, 0.017})
    for (const double v : {-0.4, 0.3})
      for (const double s : {-0.002, 0.004}) {
        const SpringForce given = at(d, v, s, p);
        const auto near = [&](std::pair<double, double> difference, double value, double rate) {
          EXPECT_NEAR(value, difference.first,
                      1e-6 * std::max(std::abs(value), 1e-3 * std::abs(given.value)));
          EXPECT_NEAR(rate, difference.second,
                      1e-6 * std::max(std::abs(rate), 1e-3 * std::abs(given.slip_rate)));
        };
        near(differences(d, [&](double h) { return at(d + h, v, s, p); }), given.by_drift,
             given.slip_by_drift);
        near(differences(v, [&](double h) { return at(d, v + h, s, p); }), 0.0, given.slip_by_rate);
        near(differences(s, [&](double h) { return at(d, v, s + h, p); }), given.by_slip, given.slip_by_slip);
        for (Index i = 0; i < p.size(); ++i)
          near(differences(p[i],
                           [&](double h) {
                             SpringVector q = p;
                             q[i] += h;
                             return at(d, v, s, q);
                           }),
               given.by_parameter[i], given.slip_by_parameter[i]);
        if (law->slips()) continue;
        EXPECT_EQ(given.slip_rate, 0.0);
        EXPECT_EQ(given.by_slip, 0.0);
      }
}

TEST_P(EverySpringLaw, TakesNoEnergyOutOfNothing) {
  // Oracle: the second law. In a closed cycle the work done on a spring is what it dissipates: none where it
  // has no memory, and never less than none.
  const SpringVector p = parameters();
  const double amplitude = 0.02;
  constexpr int steps = 20000;
  double slip = 0.0, work = 0.0, size = 0.0;
  for (int k = 0; k < 3 * steps; ++k) {  // the third cycle counts
    const double dt = 2.0 * std::numbers::pi / steps, t = dt * (k + 0.5);
    const double d = amplitude * std::sin(t), v = amplitude * std::cos(t);
    const SpringForce middle = at(d, v, slip + 0.5 * dt * at(d, v, slip, p).slip_rate, p);
    if (k >= 2 * steps) {
      work += middle.value * v * dt;
      size += std::abs(middle.value * v) * dt;
    }
    slip += dt * middle.slip_rate;
  }
  EXPECT_GE(work, -1e-6 * size);
  if (!law->slips()) {
    EXPECT_NEAR(work, 0.0, 1e-6 * size);
  }
}

TEST_P(EverySpringLaw, NamesItsParametersAsItsOptions) {
  // Oracle: the option of each key, its unit and its value; [[parameters]] know the quantity.
  const auto& entry = spring_law_registry().find(GetParam());
  expect_described(entry);
  EXPECT_LE(law->parameters().size() + 1, 8u);
  for (const SpringParameter& parameter : law->parameters()) {
    const auto option = std::find_if(entry.options.begin(), entry.options.end(),
                                     [&](const auto& one) { return one.name == parameter.key(); });
    ASSERT_NE(option, entry.options.end()) << parameter.key();
    EXPECT_EQ(option->unit, parameter.quantity.unit);
    EXPECT_EQ(std::get<double>(option->fallback), parameter.value);
    const ParameterQuantity& known = parameter_quantity(parameter.quantity.name);
    EXPECT_EQ(known.unit, parameter.quantity.unit);
    EXPECT_EQ(known.suffix, parameter.quantity.suffix);
  }
  EXPECT_THROW(spring_law_registry().make(GetParam(), {{"no_such_option", 1.0}}), std::invalid_argument);
}

}  // namespace spring_contracts
}  // namespace beamid::test
