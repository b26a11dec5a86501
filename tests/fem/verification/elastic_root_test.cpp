// A beam on springs at its root, k_w and k_theta, free at its tip. From the tip, z = L - x: w = A (cosh y +
// cos y) + B (sinh y + sin y), y = b z / L, has neither moment nor force there. At the root EI w'' = k_theta
// w' and -EI w''' = k_w w; with t = k_w L^3 / EI, r = k_theta L / EI and derivatives in y (d/dx = -(b / L)
// d/dy)
//
//     b w'' + r w' = 0       b^3 w''' - t w = 0.
#include "tests/fem/verification/oracle.hpp"

namespace beamid::elastic_root_test {
namespace {

using test::bending_stiffness, test::length;

// Expanded and divided by cosh b; the hyperbolic squares cancel by cosh^2 - sinh^2 = 1.
double frequency_equation(double b, double t, double r) {
  const double c = std::cos(b), s = std::sin(b), tanh = std::tanh(b), sech = 1.0 / std::cosh(b);
  const double b4 = b * b * b * b;
  return b4 * (c - sech) + b * b * b * r * (s + c * tanh) + b * t * (s - c * tanh) - r * t * (c + sech);
}

void expect_exact(double t, double r, int rigid = 0) {
  fem::Beam beam = test::uniform_beam();
  const double unit = bending_stiffness / length;
  beam.springs = {{0.0, t * unit / (length * length), r * unit, 0.0}};
  std::vector<double> known(rigid, 0.0);
  for (const double b : test::roots([&](double x) { return frequency_equation(x, t, r); }, 4))
    known.push_back(test::angular_frequency(b));
  test::expect_frequencies(beam, known);
}

TEST(ElasticRoot, TranslationAndRotation) {
  expect_exact(40.0, 5.0);
}

TEST(ElasticRoot, Soft) {
  expect_exact(0.3, 0.02);
}

TEST(ElasticRoot, RotationalSpringAtAPinnedRoot) {
  // The terms with t: b (sin b - cos b tanh b) = r (cos b + 1 / cosh b).
  fem::Beam beam = test::uniform_beam();
  const double r = 3.0;
  beam.supports = {{0.0, true, false}};
  beam.springs = {{0.0, 0.0, r * bending_stiffness / length, 0.0}};
  const auto equation = [&](double b) {
    return b * (std::sin(b) - std::cos(b) * std::tanh(b)) - r * (std::cos(b) + 1.0 / std::cosh(b));
  };
  std::vector<double> known;
  for (const double b : test::roots(equation, 4)) known.push_back(test::angular_frequency(b));
  test::expect_frequencies(beam, known);
}

TEST(ElasticRoot, VeryStiffSpringsAreAClamp) {
  // Oracle: the clamped beam; the springs' flexibility, 1e-12 of the beam's, remains.
  fem::Beam sprung = test::uniform_beam(), clamped = sprung;
  clamped.supports = {{0.0, true, true}};
  sprung.springs = {{0.0, 1e13, 1e13, 0.0}};
  const auto known = fem::exact_modes(clamped, 3, {});
  test::expect_frequencies(
      sprung, {known->angular_frequency[0], known->angular_frequency[1], known->angular_frequency[2]},
      {1e-7, 1e-10, 200});
}

TEST(ElasticRoot, ASpringAtMidspanAddsToTheModesThatMoveIt) {
  // Oracle: pinned-pinned, spring k at L/2. Antisymmetric modes do not see it: b = 2 n pi. Symmetric ones:
  // half the beam, w = A sin y + B sinh y, w' = 0 and EI w''' = k w / 2 at y = c = b / 2, hence k L^3 / EI
  // (tanh c - tan c) = 4 b^3 (written without poles below).
  fem::Beam beam = test::uniform_beam();
  const double k = 60.0 * bending_stiffness / (length * length * length);
  beam.supports = {{0.0, true, false}, {length, true, false}};
  beam.springs = {{0.5 * length, k, 0.0, 0.0}};
  const auto symmetric = test::roots(
      [&](double b) {
        const double c = 0.5 * b;
        return 60.0 * (std::sin(c) - std::cos(c) * std::tanh(c)) + 4.0 * b * b * b * std::cos(c);
      },
      2, 0.01, 0.5);
  const double two_pi = 2.0 * std::acos(-1.0);
  test::expect_frequencies(beam, {test::angular_frequency(symmetric[0]), test::angular_frequency(two_pi),
                                  test::angular_frequency(symmetric[1])});
}

}  // namespace
}  // namespace beamid::elastic_root_test
