// exact_modes itself: shapes, completeness, what it refuses. Its frequencies are compared with frequency
// equations in the other files here.
#include "fem/exact/exact_modes.hpp"

#include "fem/exact/exact_cantilever.hpp"
#include "tests/fem/verification/oracle.hpp"

namespace beamid::exact_modes_test {
namespace {

using test::length;

TEST(ExactModes, ShapesOfTheCantileverAreThoseOfTheClosedForm) {
  // Oracle: ExactMode, whose shape is written in scaled exponentials.
  fem::Cantilever beam{length, 7.3, 0.9, 0.4, 0.03, 0.0};
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(101, 0.0, length);
  const auto modes = fem::exact_modes(beam, 30, x);
  for (int i = 1; i <= 30; ++i) {
    const fem::ExactMode known(beam, i);
    Eigen::VectorXd shape = x.unaryExpr([&](double at) { return known.shape(at); });
    Eigen::Index largest = 0;
    shape.cwiseAbs().maxCoeff(&largest);
    shape /= double{shape[largest]};
    EXPECT_NEAR(modes->angular_frequency[i - 1] / known.angular_frequency(), 1.0, 1e-13) << i;
    EXPECT_LT((modes->deflection.col(i - 1) - shape).cwiseAbs().maxCoeff(), 1e-12) << i;
  }
}

// Something of everything, on two supports.
fem::Beam crowded_beam() {
  fem::Beam beam;
  beam.segments = {{0.7, {3.0, 1.0, 0.01, 200.0, {}, {}}}, {0.5, {1.0, 0.4, 0.0, {}, {}, {}}}};
  beam.supports = {{0.0, true, false}, {0.4, true, false}};
  beam.springs = {{0.9, 50.0, 0.3, 0.0}};
  beam.bodies = {{1.2, 0.3, 0.01, 0.05}, {0.5, 0.1, 0.001, 0.0}};
  beam.damages = {{0.2, 0.3, 0.5}};
  beam.added_masses = {{0.8, 1.0, 0.3}};
  beam.absorbers = {{1.0, 0.1, 2.0, 0.0}};
  beam.axial_load = 1.5;
  return beam;
}

TEST(ExactModes, AgreeWithFiniteElementsOnABeamOfEverything) {
  const auto exact = fem::exact_modes(crowded_beam(), 8, {});
  test::expect_frequencies(crowded_beam(),
                           {exact->angular_frequency.data(), exact->angular_frequency.data() + 8},
                           {2e-6, 1e-12, 200});
}

TEST(ExactModes, AskingForMoreModesChangesNone) {
  // Oracle: itself; a missed or repeated root would shift the rest.
  const auto few = fem::exact_modes(crowded_beam(), 5, {}), many = fem::exact_modes(crowded_beam(), 40, {});
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(many->angular_frequency[i] / few->angular_frequency[i], 1.0, 1e-13);
  for (int i = 1; i < 40; ++i) EXPECT_GT(many->angular_frequency[i], many->angular_frequency[i - 1]);
}

TEST(ExactModes, TheOtherEndAsRootGivesTheSame) {
  // Oracle: the mirror image.
  fem::Beam beam = crowded_beam(), mirror = beam;
  const double end = beam.length();
  std::reverse(mirror.segments.begin(), mirror.segments.end());
  for (auto& support : mirror.supports) support.position = end - support.position;
  for (auto& spring : mirror.springs) spring.position = end - spring.position;
  for (auto& absorber : mirror.absorbers) absorber.position = end - absorber.position;
  for (auto& body : mirror.bodies)
    body.position = end - body.position, body.eccentricity = -body.eccentricity;
  for (auto& damage : mirror.damages) damage = {end - damage.to, end - damage.from, damage.loss};
  for (auto& added : mirror.added_masses) added = {end - added.to, end - added.from, added.mass_per_length};
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(25, 0.0, end);
  const auto one = fem::exact_modes(beam, 12, x), other = fem::exact_modes(mirror, 12, x.reverse());
  for (int i = 0; i < 12; ++i) {
    EXPECT_NEAR(one->angular_frequency[i] / other->angular_frequency[i], 1.0, 1e-12) << i + 1;
    EXPECT_NEAR((one->deflection.col(i) - other->deflection.col(i)).cwiseAbs().maxCoeff(), 0.0, 1e-9)
        << i + 1;
  }
}

TEST(ExactModes, RigidModesAreATranslationAndATurnAboutTheCentreOfMass) {
  fem::Beam beam = test::uniform_beam();
  const auto modes = fem::exact_modes(beam, 2, Eigen::VectorXd::LinSpaced(3, 0.0, length));
  EXPECT_TRUE(modes->deflection.col(0).isApproxToConstant(1.0));
  EXPECT_NEAR(modes->deflection(1, 1), 0.0, 1e-15);
  EXPECT_NEAR(modes->deflection(0, 1) + modes->deflection(2, 1), 0.0, 1e-15);
}

TEST(ExactModes, DashpotsAndTheMassModelAreIgnored) {
  fem::Beam beam = test::uniform_beam(), other = beam;
  beam.supports = other.supports = {{0.0, true, true}};
  other.dashpots = {{length, 1.0, 0.1, 0.0}};
  other.mass_model = fem::MassModel::lumped;
  EXPECT_DOUBLE_EQ(fem::exact_modes(beam, 1, {})->angular_frequency[0],
                   fem::exact_modes(other, 1, {})->angular_frequency[0]);
}

// Each of these ran for ever: a bracket doubled from zero, or counts of what is not finite. Oracle: b_1 of a
// uniform cantilever, 1.8751041, wherever there is an answer.
TEST(ExactModes, EndWithNumbersOfAnySize) {
  const auto answered = [](const fem::Beam& beam, double expected) {
    try {
      EXPECT_NEAR(fem::exact_modes(beam, 3, {})->angular_frequency[0] / expected, 1.0, 1e-7);
    } catch (const std::invalid_argument&) {
      return false;
    }
    return true;
  };
  fem::Beam beam = test::uniform_beam();
  beam.supports = {{0.0, true, true}};
  const double usual = test::angular_frequency(1.8751040687);
  for (const double factor : {1e300, 1e150, 1e100, 1e-80, 1e-150}) {
    fem::Beam other = beam;
    other.segments[0].length *= factor;
    answered(other, usual / factor / factor);
  }
  for (const double factor : {1e-310, 1e-300, 1e300}) {
    fem::Beam other = beam;
    other.segments[0].section.bending_stiffness = factor;
    answered(other, usual * std::sqrt(factor / test::bending_stiffness));
  }
  fem::Beam sprung = beam;
  sprung.springs = {{length, 1e200, 1e200}};  // as good as a clamp
  answered(sprung, test::angular_frequency(4.7300407449));
}

TEST(ExactModes, RefusesWhatItCannotAnswer) {
  const fem::Beam beam = test::uniform_beam();
  EXPECT_THROW(fem::exact_modes(beam, 0, {}), std::invalid_argument);
  EXPECT_THROW(fem::exact_modes(beam, 1, Eigen::VectorXd::Constant(1, 2.0 * length)), std::invalid_argument);
  fem::Beam impossible = beam;
  impossible.segments[0].length = -1.0;
  EXPECT_THROW(fem::exact_modes(impossible, 1, {}), std::invalid_argument);
  fem::Beam squat = beam;
  squat.segments[0].section.shear_stiffness = 10.0;
  squat.axial_load = 5.0;
  EXPECT_FALSE(fem::exact_modes(squat, 1, {}).has_value());
}

}  // namespace
}  // namespace beamid::exact_modes_test
