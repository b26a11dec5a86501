// Describing functions of elastic springs and of Masing's loop. Oracles: closed forms of straight, cubic and
// hyperbolic springs, and the table of the hyperbola's naive reading.
#include "experiments/identify/backbone/secant_curve.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

namespace beamid::experiments::secant_curve_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using std::numbers::pi;

constexpr double range = 3.3;  // in x_r

template <typename Secant>
VectorXd coefficients(const SecantCurve& curve, const Secant& secant) {
  constexpr Index points = 400;
  MatrixXd rows(points, curve.terms());
  VectorXd values(points);
  for (Index i = 0; i < points; ++i) {
    const double x = range * static_cast<double>(i) / (points - 1);
    rows.row(i) = curve.shape(x).transpose();
    values[i] = secant(x);
  }
  return rows.colPivHouseholderQr().solve(values);
}

double hyperbola(double x) {
  return 1 / (1 + x);
}

TEST(SecantCurve, SumsToOneEverywhere) {
  for (const Index terms : {1, 2, 3, 4, 7, 12})
    for (const double x : {0.0, 0.01, 1.0, -2.0, 3.3, 5.0})
      EXPECT_NEAR(SecantCurve(range, terms).shape(x).sum(), 1, 1e-12) << terms << " " << x;
}

TEST(SecantCurve, HasTheSlopeOfItsDifferences) {
  const SecantCurve curve(range, 8);
  for (const double x : {0.05, 0.7, 2.9}) {
    VectorXd slope;
    curve.shape(x, &slope);
    const VectorXd difference = (curve.shape(x + 1e-6) - curve.shape(x - 1e-6)) / 2e-6;
    EXPECT_LT((slope - difference).norm(), 1e-7) << x;
  }
}

// K_eq of K3 x^3 is 3/4 K3 A^2.
TEST(SecantCurve, ElasticStiffnessOfACubicSpringIsThreeQuarters) {
  const SecantCurve curve(range, 20);
  const VectorXd cubic = coefficients(curve, [](double x) { return 1 + 0.2 * x * x; });
  for (const double a : {0.5, 1.0, 3.0})
    EXPECT_NEAR(elastic_stiffness(curve, a).dot(cubic), 1 + 0.15 * a * a, 1e-3) << a;
}

// Oracle: the midpoint rule on the hyperbola itself. K(A) A is 2.7, 7.3 and 16.1 % above it at 0.2, 0.7 and 3
// x_r; by the exact period, which harmonics shift, 2.6, 7.1 and 14.9 %.
TEST(SecantCurve, NaiveReadingOfTheHyperbolaIsThatOfItsIntegral) {
  const SecantCurve curve(range, 16);
  const VectorXd law = coefficients(curve, hyperbola);
  for (const double a : {0.2, 0.7, 3.0}) {
    constexpr int points = 20000;
    double sum = 0;
    for (int i = 0; i < points; ++i) {
      const double sine = std::sin(0.5 * pi * (i + 0.5) / points);
      sum += 2.0 / points * sine * sine * hyperbola(a * sine);
    }
    EXPECT_NEAR(elastic_stiffness(curve, a).dot(law), sum, 5e-4 * sum) << a;
  }
}

// D = 4/pi (1 + 1/r) (1 - ln(1 + r)/r) - 2/pi of the energy over 2 pi F(A) A.
TEST(SecantCurve, MasingsEnergyOfTheHyperbolaIsTheClosedForm) {
  const SecantCurve curve(range, 16);
  const VectorXd law = coefficients(curve, hyperbola);
  for (const double r : {0.1, 1.0, 3.0}) {
    const double closed = 4 / pi * (1 + 1 / r) * (1 - std::log1p(r) / r) - 2 / pi;
    EXPECT_NEAR(masing_energy(curve, r).dot(law) / (2 * pi * hyperbola(r) * r * r), closed, 2e-3 * closed)
        << r;
  }
}

TEST(SecantCurve, AStraightLineHasNoLoopAndOneStiffness) {
  const SecantCurve curve(range, 1);
  EXPECT_NEAR(elastic_stiffness(curve, 1.3)[0], 1, 1e-12);
  EXPECT_NEAR(masing_stiffness(curve, 1.3)[0], 1, 1e-12);
  EXPECT_NEAR(masing_energy(curve, 1.3)[0], 0, 1e-12);
}

}  // namespace
}  // namespace beamid::experiments::secant_curve_test
