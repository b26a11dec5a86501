// Newmark's method, HHT-alpha and generalised-alpha against their own theory.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "fem/response/response.hpp"
#include "fem/stiffness_solver.hpp"
#include "tests/fem/five_beams.hpp"
#include "tests/fem/response/oscillator_system.hpp"

namespace beamid::one_step_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using fem::ResponseMethod;
using test::one, test::oscillator, test::relative_error;

TEST(Newmark, TakesAFrequencyForTwoOverTheIntervalTimesItsArcTangent) {
  // Oracle: average acceleration moves an oscillator as cos(w' k h), w' = (2/h) atan(w h / 2), without any
  // damping.
  for (const double wh : {0.05, 0.8, 20.0}) {
    const double h = 0.01, w = wh / h, turned = 2.0 * std::atan(0.5 * wh);
    const auto response = respond(oscillator(2.0, 2.0 * w * w), fem::Undamped{}, {one(1.0), {}, {}},
                                  {h, 10000}, {"newmark", {}});
    for (Index k = 0; k < 10000; ++k) {
      ASSERT_NEAR(response.displacement(0, k), std::cos(turned * double(k)), 1e-9) << wh << " " << k;
      ASSERT_NEAR(response.acceleration(0, k) / (w * w), -std::cos(turned * double(k)), 1e-9)
          << wh << " " << k;
    }
  }
}

TEST(Newmark, KeepsTheEnergyOfAnUndampedBeam) {
  // Oracle: average acceleration conserves v^T M v + q^T K q exactly. 20,000 steps after a release.
  const auto system = assemble(test::steel_beam(0.36049), 100);
  const VectorXd released = 0.012 * static_shape(system);
  const auto response = respond(system, fem::Undamped{}, {released, {}, {}},
                                {1e-3, 20001, {0, 100, 10000, 20000}}, {"newmark", {}});
  const double start = system.stiffness.energy(released);
  for (Index i = 0; i < 4; ++i) {
    const VectorXd v = response.field_velocity.col(i);
    EXPECT_NEAR(
        (v.dot(system.mass * v) + system.stiffness.energy(response.field_displacement.col(i))) / start, 1.0,
        1e-9);
  }
}

TEST(Newmark, KeepsItsDigitsOnFineMeshes) {
  // Oracle: (2/h) atan(w h / 2) with w from the strain-form quotient. With an assembled K the
  // same loop errs by 2e-6 here.
  const auto system = assemble(test::steel_beam(0.36049), 1000);
  const auto modes = fem::modes(system, 1);
  const double h = 1e-3, turned = 2.0 * std::atan(0.5 * h * modes.angular_frequency[0]);
  const VectorXd start = modes.shape.col(0);
  const auto response = respond(system, fem::Undamped{}, {start, {}, {}}, {h, 3001}, {"newmark", {}});
  const double tip = response.displacement(0, 0);
  for (Index k = 0; k <= 3000; k += 50)
    EXPECT_NEAR(response.displacement(0, k) / tip, std::cos(turned * double(k)), 2e-10) << k;
}

// Coefficients of the polynomial with three given roots, highest power first.
Eigen::Vector4d cubic(double a, double b, double c) {
  return {1.0, -(a + b + c), a * b + a * c + b * c, -a * b * c};
}

// Motions far too fast for the interval: d_k is a sum of powers of the three roots, so it satisfies their
// recurrence.
double recurrence_error(const ResponseMethod& method, const Eigen::Vector4d& coefficients) {
  const double h = 1.0, w = 1e4;
  const auto response = respond(oscillator(1.0, w * w), fem::Undamped{}, {one(1.0), {}, {}}, {h, 12}, method);
  double worst = 0.0;
  for (Index k = 3; k < 12; ++k) {
    double sum = 0.0, size = 0.0;
    for (Index i = 0; i < 4; ++i) {
      sum += coefficients[i] * response.displacement(0, k - i);
      size += std::abs(coefficients[i] * response.displacement(0, k - i));
    }
    worst = std::max(worst, std::abs(sum) / std::max(size, 1e-30));
  }
  return worst;
}

TEST(GeneralisedAlpha, MultipliesFastMotionsByRhoInfinity) {
  // Oracle: all three roots of the amplification matrix tend to -rho_infinity [chung1993]; here w h = 1e4.
  for (const double rho : {0.3, 0.5, 0.8, 1.0})
    EXPECT_LT(recurrence_error({"generalised_alpha", {{"rho_infinity", rho}}}, cubic(-rho, -rho, -rho)), 1e-6)
        << rho;
}

TEST(HhtAlpha, MultipliesFastMotionsByOnePlusAlphaOverOneMinusAlpha) {
  // Oracle: its roots tend to -(1 + alpha)/(1 - alpha), twice, and alpha/(1 + alpha) [hilber1977].
  for (const double alpha : {-0.05, -0.1, -0.3}) {
    const double root = -(1 + alpha) / (1 - alpha);
    EXPECT_LT(recurrence_error({"hht_alpha", {{"alpha", alpha}}}, cubic(root, root, alpha / (1 + alpha))),
              1e-7)
        << alpha;
  }
}

TEST(OneStepMethods, AreOfSecondOrder) {
  // Oracle: the exact modal response of a damped beam under a force that both interpolate alike, a ramp from
  // rest.
  const auto system = assemble(test::steel_beam(0.36049), 4);
  const fem::RayleighDamping law{{3.0, 0.02}, {30.0, 0.02}};
  const auto error = [&](const ResponseMethod& method, Index samples) {
    const double h = 0.4 / double(samples - 1);
    fem::Loading loading{{}, {}, MatrixXd::Zero(2, samples)};
    loading.inputs.row(0) = Eigen::RowVectorXd::LinSpaced(samples, 0.0, 1.0);
    const auto exact = respond(system, law, loading, {h, samples}),
               found = respond(system, law, loading, {h, samples}, method);
    return std::abs(found.displacement(0, samples - 1) - exact.displacement(0, samples - 1)) /
           exact.displacement.cwiseAbs().maxCoeff();
  };
  for (const ResponseMethod& method : {ResponseMethod{"newmark", {}}, ResponseMethod{"hht_alpha", {}},
                                       ResponseMethod{"generalised_alpha", {}}}) {
    const double coarse = error(method, 4001), fine = error(method, 8001);
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.03) << method.name;
    EXPECT_LT(fine, 1e-4) << method.name;
  }
}

TEST(OneStepMethods, WithNeitherDampingOptionAreAverageAcceleration) {
  const auto system = assemble(test::steel_beam(0.36049), 10);
  const fem::Loading loading{0.012 * static_shape(system), {}, {}};
  const fem::TimeGrid grid{1e-3, 2000};
  const auto newmark = respond(system, fem::Undamped{}, loading, grid, {"newmark", {}});
  EXPECT_LT(relative_error(
                respond(system, fem::Undamped{}, loading, grid, {"hht_alpha", {{"alpha", 0.0}}}).displacement,
                newmark.displacement),
            1e-13);
  // rho = 1: alpha_m = alpha_f = 1/2, the same displacements where no force acts.
  EXPECT_LT(relative_error(respond(system, fem::Undamped{}, loading, grid,
                                   {"generalised_alpha", {{"rho_infinity", 1.0}}})
                               .displacement,
                           newmark.displacement),
            1e-7);
}

TEST(OneStepMethods, FollowDashpotsOfTheModel) {
  // Oracle: exact modal response with the dashpots coupling the modes; second order in the interval.
  fem::Beam beam = test::steel_beam(0.36049);
  beam.dashpots = {{beam.length(), 3.0, 0.0, 0.0}};
  const auto system = assemble(beam, 10);
  const fem::Loading loading{0.012 * fem::modes(system, 1).shape.col(0), {}, {}};
  const fem::TimeGrid grid{1e-4, 10000};
  const auto exact = respond(system, fem::Undamped{}, loading, grid);
  EXPECT_LT(relative_error(respond(system, fem::Undamped{}, loading, grid, {"newmark", {}}).displacement,
                           exact.displacement),
            2e-5);
}

TEST(OneStepMethods, SayWhyTheyRefuseALaw) {
  const auto system = oscillator(1.0, 1.0);
  for (const char* method : {"newmark", "hht_alpha", "generalised_alpha", "cvode", "arkode"})
    for (const fem::DampingLaw& law :
         {fem::DampingLaw(fem::ModalDamping{{0.01}}), fem::DampingLaw(fem::StructuralDamping{0.01})})
      try {
        respond(system, law, {one(1.0), {}, {}}, {0.1, 10}, {method, {}});
        ADD_FAILURE() << method << " accepts " << name(law);
      } catch (const std::invalid_argument& error) {
        EXPECT_EQ(std::string(error.what()).rfind(std::string(method) + ": " + name(law) + " damping", 0), 0u)
            << error.what();
      }
}

TEST(OneStepMethods, RefuseARayleighLawThatFeedsAMode) {
  const auto system = oscillator(1.0, 4.0 * M_PI * M_PI);  // 1 Hz
  EXPECT_THROW(respond(system, fem::RayleighDamping{{10.0, 0.0}, {20.0, 0.1}}, {one(1.0), {}, {}}, {0.1, 10},
                       {"newmark", {}}),
               std::invalid_argument);
  EXPECT_THROW(respond(system, fem::RayleighDamping{{10.0, 0.1}, {20.0, 0.0}}, {one(1.0), {}, {}}, {0.1, 10},
                       {"newmark", {}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace beamid::one_step_test
