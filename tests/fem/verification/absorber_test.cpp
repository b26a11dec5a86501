// A tuned absorber: a mass m on a spring k, omega_a^2 = k / m. The beam feels the force of a mass
// m omega_a^2 / (omega_a^2 - omega^2), so that any frequency equation with a mass there serves; for the tip
// of a cantilever, with mu(b) that mass over the beam's [craig2006],
//
//     1 + cos b cosh b + mu b (cos b sinh b - sin b cosh b) = 0,     multiplied by omega_a^2 - omega^2.
#include "tests/fem/verification/oracle.hpp"

namespace beamid::absorber_test {
namespace {

using test::length, test::mass_per_length;

double equation(double b, double mass_ratio, double tuning) {  // tuning: b of omega_a
  const double b4 = std::pow(b, 4), a4 = std::pow(tuning, 4);
  const double tanh = std::tanh(b), sech = 1.0 / std::cosh(b);
  return (a4 - b4) * (sech + std::cos(b)) + mass_ratio * a4 * b * (std::cos(b) * tanh - std::sin(b));
}

void expect_exact(double mass_ratio, double tuning) {
  fem::Beam beam = test::uniform_beam();
  beam.supports = {{0.0, true, true}};
  const double mass = mass_ratio * mass_per_length * length;
  beam.absorbers = {{length, mass, mass * std::pow(test::angular_frequency(tuning), 2), 0.0}};
  std::vector<double> known;
  for (const double b : test::roots([&](double x) { return equation(x, mass_ratio, tuning); }, 4, 0.002))
    known.push_back(test::angular_frequency(b));
  test::expect_frequencies(beam, known);
}

TEST(Absorber, TunedToTheFirstModeSplitsIt) {
  expect_exact(0.05, 1.8751);
}

TEST(Absorber, TunedToTheSecondMode) {
  expect_exact(0.02, 4.6941);
}

TEST(Absorber, VeryStiffItIsATipMass) {
  fem::Beam beam = test::uniform_beam(), rigid = beam;
  beam.supports = rigid.supports = {{0.0, true, true}};
  rigid.bodies = {{length, 0.4, 0.0, 0.0}};
  beam.absorbers = {{length, 0.4, 1e12, 0.0}};
  const auto one = fem::exact_modes(beam, 3, {}), other = fem::exact_modes(rigid, 3, {});
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(one->angular_frequency[i] / other->angular_frequency[i], 1.0, 1e-8);
}

TEST(Absorber, OnAHeldPointItMovesAlone) {
  // Oracle: sqrt(k / m), beside the frequencies of the beam without it.
  fem::Beam beam = test::uniform_beam();
  beam.supports = {{0.0, true, true}, {length, true, false}};
  const auto bare = fem::exact_modes(beam, 2, {});
  const double alone = 0.5 * (bare->angular_frequency[0] + bare->angular_frequency[1]);
  beam.absorbers = {{length, 0.3, 0.3 * alone * alone, 0.0}};
  test::expect_frequencies(beam, {bare->angular_frequency[0], alone, bare->angular_frequency[1]});
  const auto modes = fem::exact_modes(beam, 2, Eigen::VectorXd::LinSpaced(5, 0.0, length));
  EXPECT_EQ(modes->deflection.col(1).cwiseAbs().maxCoeff(), 0.0);
}

TEST(Absorber, FollowsTheBaseRigidly) {
  // Oracle: the base's acceleration loads every mass: the force's sum is the mass that can move.
  fem::Beam beam = test::uniform_beam();
  beam.absorbers = {{0.5 * length, 0.3, 20.0, 0.0}};
  const auto system = fem::assemble(beam, 10, {});
  double sum = 0.0;
  for (Eigen::Index i = 0; i < system.size(); ++i)
    if (system.coordinates[i].kind != fem::Coordinate::Kind::rotation) sum += system.inputs.coeff(i, 0);
  EXPECT_NEAR(sum, -(beam.mass() + 0.3), 1e-12);
}

}  // namespace
}  // namespace beamid::absorber_test
