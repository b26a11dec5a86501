// Cubic springs and quadratic dashpots against closed forms.
#include <gtest/gtest.h>

#include <boost/math/special_functions/jacobi_elliptic.hpp>
#include <cmath>

#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "fem/response/response.hpp"
#include "tests/fem/five_beams.hpp"
#include "tests/fem/response/oscillator_system.hpp"

namespace beamid::nonlinear_test {
namespace {

using Eigen::Index, Eigen::VectorXd;
using fem::ResponseMethod;
using test::one, test::oscillator, test::relative_error;

fem::StructuralSystem nonlinear_oscillator(double w, double cubic, double quadratic) {
  auto system = oscillator(1.0, w * w);
  system.nonlinear_forces = {{test::sparse(Eigen::MatrixXd::Ones(1, 1)), cubic, quadratic}};
  return system;
}

// x'' + w^2 x + k3 x^3 = 0 from rest at A: x = A cn(W t, k), W^2 = w^2 + k3 A^2, k^2 = k3 A^2 / (2 W^2).
VectorXd duffing(double w, double k3, double a, double h, Index samples) {
  const double frequency = std::sqrt(w * w + k3 * a * a), modulus = std::sqrt(0.5 * k3) * a / frequency;
  VectorXd x(samples);
  for (Index k = 0; k < samples; ++k) x[k] = a * boost::math::jacobi_cn(modulus, frequency * h * double(k));
  return x;
}

TEST(Duffing, AdaptiveMethodsFollowTheEllipticFunction) {
  // Oracle: Jacobi's elliptic cosine; k3 A^2 = 4 w^2, 30 periods.
  const double w = 5.0, k3 = 400.0, a = 0.5;
  const VectorXd exact = duffing(w, k3, a, 0.01, 1800);
  const auto system = nonlinear_oscillator(w, k3, 0.0);
  for (const char* method : {"arkode", "cvode"}) {
    const auto response = respond(system, fem::Undamped{}, {one(a), {}, {}}, {0.01, 1800},
                                  {method, {{"tolerance", 1e-10}, {"absolute_tolerance", 1e-12}}});
    EXPECT_LT(relative_error(response.displacement.row(0).transpose(), exact), 1e-5) << method;
  }
}

TEST(Duffing, OneStepMethodsConvergeAtSecondOrder) {
  const double w = 5.0, k3 = 400.0, a = 0.5;
  const auto system = nonlinear_oscillator(w, k3, 0.0);
  for (const ResponseMethod& method : {ResponseMethod{"newmark", {}}, ResponseMethod{"hht_alpha", {}},
                                       ResponseMethod{"generalised_alpha", {}}}) {
    const auto error = [&](double h, Index samples) {
      const auto response = respond(system, fem::Undamped{}, {one(a), {}, {}}, {h, samples}, method);
      return relative_error(response.displacement.row(0).transpose(), duffing(w, k3, a, h, samples));
    };
    const double coarse = error(1e-3, 1001), fine = error(5e-4, 2001);
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.05) << method.name;
    EXPECT_LT(fine, 1e-4) << method.name;
  }
}

// Turning points of x, by the cubic through both neighbours of a change of sign of v.
std::vector<double> turning_points(const fem::Response& response, double h) {
  std::vector<double> found{std::abs(response.displacement(0, 0))};
  for (Index k = 1; k + 1 < response.time.size(); ++k) {
    const double v0 = response.velocity(0, k), v1 = response.velocity(0, k + 1);
    if (v0 * v1 >= 0.0) continue;
    const double s = v0 / (v0 - v1), x0 = response.displacement(0, k), x1 = response.displacement(0, k + 1);
    found.push_back(std::abs((1 + 2 * s) * (1 - s) * (1 - s) * x0 + s * s * (3 - 2 * s) * x1 +
                             h * s * (1 - s) * ((1 - s) * v0 - s * v1)));
  }
  return found;
}

TEST(QuadraticDashpot, LosesTheAmplitudeThatItsEnergyEquationSays) {
  // Oracle: between turning points v^2 satisfies d(v^2)/dx -+ 2 c v^2 = -2 w^2 x, whose solution vanishes at
  // both: (1 + 2 c A_1) e^(-2 c A_1) = (1 - 2 c A_2) e^(2 c A_2).
  const double c = 0.8, h = 1e-3;
  const auto system = nonlinear_oscillator(6.0, 0.0, c);
  for (const ResponseMethod& method :
       {ResponseMethod{"arkode", {{"tolerance", 1e-10}, {"absolute_tolerance", 1e-12}}},
        ResponseMethod{"cvode", {{"tolerance", 1e-10}, {"absolute_tolerance", 1e-12}}},
        ResponseMethod{"newmark", {}}}) {
    const auto response = respond(system, fem::Undamped{}, {one(0.7), {}, {}}, {h, 8000}, method);
    const std::vector<double> peaks = turning_points(response, h);
    ASSERT_GT(peaks.size(), 12u);
    for (std::size_t i = 0; i + 1 < peaks.size(); ++i) {
      const double left = (1 + 2 * c * peaks[i]) * std::exp(-2 * c * peaks[i]);
      const double right = (1 - 2 * c * peaks[i + 1]) * std::exp(2 * c * peaks[i + 1]);
      EXPECT_NEAR(left, right, method.name == "newmark" ? 3e-6 : 2e-8) << method.name << " " << i;
    }
  }
}

TEST(NonlinearBeam, NewmarkAndRungeKuttaAgree) {
  // Two methods: Newton on the forces alone, and SUNDIALS' Newton on the whole, with both forces, a dashpot
  // and damping.
  fem::Beam beam = test::steel_beam(0.36049);
  beam.springs = {{beam.length(), 20.0, 0.0, 4e5}, {0.55, 0.0, 0.0, 1e6}};
  beam.dashpots = {{beam.length(), 0.3, 0.0, 2.0}};
  const auto system = assemble(beam, 10);
  ASSERT_EQ(system.nonlinear_forces.size(), 3u);
  const fem::RayleighDamping law{{3.0, 0.01}, {60.0, 0.02}};
  const fem::Loading loading{fem::modes(system, 1).shape.col(0) * 0.02, {}, {}};
  const fem::TimeGrid grid{5e-5, 20001};
  const auto reference =
      respond(system, law, loading, grid, {"arkode", {{"tolerance", 1e-9}, {"absolute_tolerance", 1e-12}}});
  const auto newmark = respond(system, law, loading, grid, {"newmark", {}});
  const auto cvode =
      respond(system, law, loading, grid, {"cvode", {{"tolerance", 1e-9}, {"absolute_tolerance", 1e-12}}});
  EXPECT_LT(relative_error(newmark.displacement, reference.displacement), 2e-5);
  EXPECT_LT(relative_error(cvode.displacement, reference.displacement), 2e-5);
}

TEST(NonlinearBeam, IsRefusedByTheModalMethod) {
  try {
    respond(nonlinear_oscillator(1.0, 1.0, 0.0), fem::Undamped{}, {one(1.0), {}, {}}, {0.1, 10});
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("expected newmark, hht_alpha"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace beamid::nonlinear_test
