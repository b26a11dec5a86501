// Cantilevers whose section shrinks towards the tip, z the distance from the (extrapolated) sharp end.
//
// EI ~ z^(n+2), rho A ~ z^n: n = 1 a wedge of constant width, n = 2 a cone or a pyramid. (z^(n+2) w'')'' =
// k^2 z^n w has the four solutions of (z^(n+1) w')' = -+ k z^n w:
//     z w'' = -+ k w - (n + 1) w',   (z^(n+2) w'')' = -+ k z^(n+1) w',   (z^(n+2) w'')'' = k^2 z^n w,
// which are Bessel functions, w = z^(-n/2) {J, Y, I, K}_n(q), q = 2 sqrt(k z) [kirchhoff1879]: J and Y with
// the upper sign, I and K with the lower. Their slopes are sqrt(k) z^(-(n+1)/2) {-J, -Y, I, -K}_(n+1)(q).
#include <Eigen/LU>
#include <boost/math/special_functions/bessel.hpp>

#include "tests/fem/verification/oracle.hpp"

namespace beamid::taper_test {
namespace {

constexpr double youngs_modulus = 3.1, density = 0.8, depth = 0.24, span = 2.0;

// EI and rho A of a section of height h(s) = depth (1 - s (1 - ratio)), s = x / L, and of width proportional
// to h^(n-1). `shape` is I / (width h^3) and `area` A / (width h).
fem::Beam tapered(int n, double ratio, double shape, double area) {
  const auto height = fem::Variation::linear(depth, ratio * depth);
  const fem::Variation width = n == 1 ? fem::Variation(1.0) : height;
  const fem::Variation square = height * height;
  const fem::Variation inertia = n == 1 ? square * height : square * square;
  fem::Beam beam;
  beam.segments = {{span,
                    {inertia * fem::Variation(youngs_modulus * shape),
                     width * height * fem::Variation(density * area),
                     0.0,
                     {},
                     {},
                     {}}}};
  beam.supports = {{0.0, true, true}};
  return beam;
}

// omega of q at the root: k = q^2 / (4 z), k^2 = omega^2 rho A / EI z^2 there.
double angular_frequency(double q, double ratio, double shape, double area) {
  const double root = span / (1.0 - ratio);
  return q * q / (4.0 * root * root) * std::sqrt(youngs_modulus * shape / (density * area)) * depth;
}

// A sharp tip leaves J and I, whose shapes and slopes vanish together at the root: J_n I_(n+1) + J_(n+1) I_n
// = 0.
std::vector<double> sharp_roots(int n, int count) {
  using boost::math::cyl_bessel_i, boost::math::cyl_bessel_j;
  return test::roots(
      [n](double q) {
        return (cyl_bessel_j(n, q) * cyl_bessel_i(n + 1, q) + cyl_bessel_j(n + 1, q) * cyl_bessel_i(n, q)) /
               std::exp(q);
      },
      count, 0.01, 1.0);
}

constexpr double wedge_shape = 1.0 / 12.0, pi = 3.14159265358979323846;

TEST(Taper, SharpWedge) {
  const auto q = sharp_roots(1, 3);
  EXPECT_NEAR(q[0] * q[0] / 4.0, 5.315,
              0.0005);  // the number in the handbooks: omega L^2 / h sqrt(12 rho / E)
  std::vector<double> known;
  for (const double root : q) known.push_back(angular_frequency(root, 0.0, wedge_shape, 1.0));
  test::expect_frequencies(tapered(1, 0.0, wedge_shape, 1.0), known, {5e-6});
}

TEST(Taper, SharpCone) {
  const auto q = sharp_roots(2, 3);
  EXPECT_NEAR(q[0] * q[0] / 4.0, 8.719,
              0.0005);  // the number in the handbooks: omega L^2 / d sqrt(16 rho / E)
  std::vector<double> known;
  for (const double root : q) known.push_back(angular_frequency(root, 0.0, pi / 64.0, pi / 4.0));
  test::expect_frequencies(tapered(2, 0.0, pi / 64.0, pi / 4.0), known, {5e-6});
}

// Cut off at z = ratio x root: w'' and (z^(n+2) w'')' vanish there, that is z w'' = -+ k w - (n + 1) w' and
// -+ w'.
std::vector<double> truncated_roots(int n, double ratio, int count) {
  using namespace boost::math;
  const auto equation = [&](double q) {
    const double tip = q * std::sqrt(ratio), growth = std::exp(q - tip);
    // columns J, Y, I, K; the last two scaled to order one
    const double scale[4] = {1.0, 1.0, std::exp(-q), std::exp(tip)}, sign[4] = {-1.0, -1.0, 1.0, 1.0};
    const auto value = [&](int order, double at) {
      return Eigen::RowVector4d(cyl_bessel_j(order, at) * scale[0], cyl_neumann(order, at) * scale[1],
                                cyl_bessel_i(order, at) * scale[2], cyl_bessel_k(order, at) * scale[3]);
    };
    const Eigen::RowVector4d turn(-1.0, -1.0, 1.0, -1.0);
    Eigen::Matrix4d m;
    m.row(0) = value(n, q);
    m.row(1) = value(n + 1, q).cwiseProduct(turn);
    const Eigen::RowVector4d slope = value(n + 1, tip).cwiseProduct(turn);
    for (int i = 0; i < 4; ++i) {
      m(2, i) = sign[i] * 0.5 * tip * value(n, tip)[i] - (n + 1) * slope[i];  // times z^(n/2+1) / sqrt(k)
      m(3, i) = sign[i] * slope[i];
    }
    return m.determinant() * (growth > 0.0 ? 1.0 : 0.0);
  };
  return test::roots(equation, count, 0.01, 1.0);
}

TEST(Taper, TruncatedWedge) {
  std::vector<double> known;
  for (const double root : truncated_roots(1, 0.4, 4))
    known.push_back(angular_frequency(root, 0.4, wedge_shape, 1.0));
  test::expect_frequencies(tapered(1, 0.4, wedge_shape, 1.0), known);
}

TEST(Taper, TruncatedPyramid) {
  // Besides the equation above: omega = lambda h_tip / L^2 sqrt(E / 12 rho) published for h_root / h_tip =
  // b_root / b_tip = 4 [mabie1972].
  const double published[] = {23.289, 73.9, 165.23, 299.7, 478.1};
  std::vector<double> known;
  for (const double root : truncated_roots(2, 0.25, 5))
    known.push_back(angular_frequency(root, 0.25, wedge_shape, 1.0));
  const double unit = 0.25 * depth / (span * span) * std::sqrt(youngs_modulus / (12.0 * density));
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(known[i] / unit / published[i], 1.0, 1e-3) << "mode " << i + 1;
  test::expect_frequencies(tapered(2, 0.25, wedge_shape, 1.0), known, {1e-6});
}

TEST(Taper, ManyUniformStepsApproachIt) {
  // Oracle of exact_modes on many segments: the wedge above, cut into steps of the section at their middle;
  // the error falls with the square of their length.
  const fem::Variation height = fem::Variation::linear(depth, 0.4 * depth);
  const double known = angular_frequency(truncated_roots(1, 0.4, 1)[0], 0.4, wedge_shape, 1.0);
  const auto error = [&](int steps) {
    fem::Beam beam;
    for (int i = 0; i < steps; ++i) {
      const double h = height((i + 0.5) / steps);
      beam.segments.push_back(
          {span / steps, {youngs_modulus * h * h * h / 12.0, density * h, 0.0, {}, {}, {}}});
    }
    beam.supports = {{0.0, true, true}};
    return fem::exact_modes(beam, 1, {})->angular_frequency[0] / known - 1.0;
  };
  EXPECT_NEAR(error(20) / error(40), 4.0, 0.02);
  EXPECT_LT(std::abs(error(160)), 3e-5);
}

TEST(Taper, NoExactModesAreClaimedForIt) {
  EXPECT_FALSE(fem::exact_modes(tapered(1, 0.4, wedge_shape, 1.0), 1, {}).has_value());
}

}  // namespace
}  // namespace beamid::taper_test
