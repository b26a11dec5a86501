// A cantilever with a rigid body at its tip: mass M, rotary inertia J about its own centre, e beyond the tip.
//
// w = A (cosh y - cos y) + B (sinh y - sin y), y = b x / L, is clamped at the root. The body's centre moves
// by w + e w', so that the tip carries the shear force and the bending moment
//
//     -EI w''' = omega^2 M (w + e w')        EI w'' = omega^2 (M e (w + e w') + J w').
//
// With mu = M / (rho A L), kappa = J / (rho A L^3), epsilon = e / L and derivatives in y (at y = b)
//
//     w''' + mu b (w + epsilon b w') = 0     w'' - mu epsilon b^2 (w + epsilon b w') - kappa b^3 w' = 0;
//
// their determinant over the two shapes is the frequency equation.
#include "tests/fem/verification/oracle.hpp"

namespace beamid::tip_body_test {
namespace {

using test::length, test::mass_per_length;

// Divided by cosh b.
double frequency_equation(double b, double mu, double kappa, double epsilon) {
  const double scaled_cosh = 1.0, scaled_sinh = std::tanh(b), sech = 1.0 / std::cosh(b);
  const double c = std::cos(b), s = std::sin(b);
  // derivatives 0..3 of cosh y - cos y and of sinh y - sin y; the hyperbolic part over cosh b
  const double first[4][2] = {{scaled_cosh, -c}, {scaled_sinh, s}, {scaled_cosh, c}, {scaled_sinh, -s}};
  const double second[4][2] = {{scaled_sinh, -s}, {scaled_cosh, -c}, {scaled_sinh, s}, {scaled_cosh, c}};
  // The determinant is bilinear: hyperbolic x hyperbolic is of order cosh^2 but cancels to order one by
  // cosh^2 - sinh^2 = 1. Written out, with p the force and q the moment condition:
  const auto force = [&](const double(&u)[4][2], int part) {
    return u[3][part] + mu * b * (u[0][part] + epsilon * b * u[1][part]);
  };
  const auto moment = [&](const double(&u)[4][2], int part) {
    return u[2][part] - mu * epsilon * b * b * (u[0][part] + epsilon * b * u[1][part]) -
           kappa * b * b * b * u[1][part];
  };
  const double mixed = moment(first, 0) * force(second, 1) + moment(first, 1) * force(second, 0) -
                       moment(second, 0) * force(first, 1) - moment(second, 1) * force(first, 0);
  const double trigonometric = moment(first, 1) * force(second, 1) - moment(second, 1) * force(first, 1);
  // hyperbolic part: with u = (C, S), v = (S, C) of C^2 - S^2 = 1
  const double r = kappa * b * b * b + mu * epsilon * epsilon * b * b * b, g = mu * epsilon * b * b,
               p = mu * b;
  const double hyperbolic = (1.0 - g) * (1.0 + g) + r * p;
  return mixed + (trigonometric + hyperbolic) * sech;
}

void expect_exact(double mu, double kappa, double epsilon) {
  fem::Beam beam = test::uniform_beam();
  beam.supports = {{0.0, true, true}};
  const double mass = mass_per_length * length;
  beam.bodies = {{length, mu * mass, kappa * mass * length * length, epsilon * length}};
  std::vector<double> known;
  for (const double b : test::roots([&](double x) { return frequency_equation(x, mu, kappa, epsilon); }, 4))
    known.push_back(test::angular_frequency(b));
  test::expect_frequencies(beam, known);
}

TEST(TipBody, Mass) {
  expect_exact(0.7, 0.0, 0.0);
}

TEST(TipBody, MassAHundredTimesTheBeams) {
  expect_exact(100.0, 0.0, 0.0);
}

TEST(TipBody, RotaryInertia) {
  expect_exact(0.7, 0.04, 0.0);
}

TEST(TipBody, Eccentricity) {
  expect_exact(0.7, 0.04, 0.15);
}

TEST(TipBody, EccentricityTowardsTheRoot) {
  expect_exact(0.7, 0.02, -0.1);
}

TEST(TipBody, ARigidBarBeyondTheTipIsABodyAtItsMiddle) {
  // Oracle: a rigid bar is a beam a million times as stiff.
  const double bar = 0.4, bar_mass = 0.5;
  fem::Beam body = test::uniform_beam(), stiff = body;
  body.supports = stiff.supports = {{0.0, true, true}};
  body.bodies = {{length, bar_mass, bar_mass * bar * bar / 12.0, 0.5 * bar}};
  stiff.segments.push_back({bar, {7.3e8, bar_mass / bar, 0.0, {}, {}, {}}});
  const auto one = fem::exact_modes(body, 4, {}), other = fem::exact_modes(stiff, 4, {});
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(one->angular_frequency[i] / other->angular_frequency[i], 1.0, 1e-6) << "mode " << i + 1;
}

}  // namespace
}  // namespace beamid::tip_body_test
