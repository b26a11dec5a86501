// What lies on a part of the length: a loss of stiffness and a mass that rides along.
#include "tests/fem/verification/oracle.hpp"

namespace beamid::damage_test {
namespace {

using test::bending_stiffness, test::length, test::mass_per_length;

std::vector<double> exact(const fem::Beam& beam, int count) {
  const auto modes = fem::exact_modes(beam, count, {});
  return {modes->angular_frequency.data(), modes->angular_frequency.data() + count};
}

TEST(LocalLoss, IsABeamOfThreeSegments) {
  // Oracle: the exact modes of the three segments, written out.
  fem::Beam beam = test::uniform_beam();
  beam.supports = {{0.0, true, true}};
  beam.damages = {{0.3, 0.47, 0.6}};
  fem::Beam parts = beam;
  parts.damages.clear();
  const fem::Section whole{bending_stiffness, mass_per_length, 0.0, {}, {}, {}};
  const fem::Section weak{0.4 * bending_stiffness, mass_per_length, 0.0, {}, {}, {}};
  parts.segments = {{0.3, whole}, {0.17, weak}, {length - 0.47, whole}};
  test::expect_frequencies(beam, exact(parts, 4));
}

TEST(LocalLoss, OverTheWholeLengthScalesEveryFrequency) {  // by sqrt(1 - loss)
  fem::Beam beam = test::uniform_beam();
  beam.supports = {{0.0, true, true}};
  std::vector<double> known = exact(beam, 4);
  for (double& omega : known) omega *= std::sqrt(0.7);
  beam.damages = {{0.0, length, 0.3}};
  test::expect_frequencies(beam, known);
}

TEST(LocalLoss, OfAShortPartIsARotationalSpring) {
  // Oracle: perturbation. A part of length d at a place of curvature phi'' flexes by d loss / (1 - loss) / EI
  // more; to first order omega^2 falls by EI phi''^2 d loss/(1-loss) / (modal mass), for the pinned-pinned
  // mode at midspan phi = sin, modal mass rho A L / 2: relative change of omega^2 = -2 (d / L) loss / (1 -
  // loss).
  fem::Beam beam = test::uniform_beam();
  beam.supports = {{0.0, true, false}, {length, true, false}};
  const double before = exact(beam, 1)[0], d = 1e-6 * length, loss = 0.5;
  beam.damages = {{0.5 * (length - d), 0.5 * (length + d), loss}};
  const double change = std::pow(exact(beam, 1)[0] / before, 2) - 1.0;
  EXPECT_NEAR(change / (-2.0 * d / length * loss / (1.0 - loss)), 1.0, 1e-5);
  const double finite =
      std::pow(fem::modes(fem::assemble(beam, 200, {}), 1).angular_frequency[0] / before, 2) - 1.0;
  EXPECT_NEAR(finite / change, 1.0, 1e-3);
}

TEST(AddedMass, OverTheWholeLengthScalesEveryFrequency) {  // by 1 / sqrt(1 + added / rho A)
  fem::Beam beam = test::uniform_beam();
  beam.supports = {{0.0, true, true}, {length, true, false}};
  std::vector<double> known = exact(beam, 4);
  for (double& omega : known) omega /= std::sqrt(1.0 + 0.4 / mass_per_length);
  beam.added_masses = {{0.0, length, 0.4}};
  test::expect_frequencies(beam, known);
}

TEST(AddedMass, OnAPartIsAHeavierSegment) {
  // Oracle: exact modes of the two segments, written out.
  fem::Beam beam = test::uniform_beam();
  beam.supports = {{0.0, true, true}};
  beam.added_masses = {{0.8, length, 1.1}};
  fem::Beam parts = beam;
  parts.added_masses.clear();
  parts.segments = {{0.8, {bending_stiffness, mass_per_length, 0.0, {}, {}, {}}},
                    {length - 0.8, {bending_stiffness, mass_per_length + 1.1, 0.0, {}, {}, {}}}};
  test::expect_frequencies(beam, exact(parts, 4));
}

TEST(AddedMass, OnAVeryShortPartIsABody) {
  // Oracle: the body of the same mass at its middle; what the part's length leaves is of its first order
  // squared.
  fem::Beam beam = test::uniform_beam(), body = beam;
  beam.supports = body.supports = {{0.0, true, true}};
  const double d = 1e-5;
  beam.added_masses = {{0.7 - 0.5 * d, 0.7 + 0.5 * d, 0.3 / d}};
  body.bodies = {{0.7, 0.3, 0.0, 0.0}};
  const auto one = exact(beam, 3), other = exact(body, 3);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(one[i] / other[i], 1.0, 1e-8);
}

TEST(SteppedBeam, JoinsTwoHalvesOfAKnownOne) {
  // Oracle: segments of equal section are one beam, and their order is a matter of which end is the root.
  fem::Beam beam = test::uniform_beam(), turned = beam;
  const fem::Section thick{bending_stiffness, mass_per_length, 0.0, {}, {}, {}};
  const fem::Section thin{0.2 * bending_stiffness, 0.5 * mass_per_length, 0.0, {}, {}, {}};
  beam.segments = {{0.5, thick}, {0.4, thick}, {0.4, thin}};
  beam.supports = {{0.0, true, true}};
  turned.segments = {{0.4, thin}, {0.9, thick}};
  turned.supports = {{length, true, true}};
  test::expect_frequencies(beam, exact(turned, 5));
}

}  // namespace
}  // namespace beamid::damage_test
