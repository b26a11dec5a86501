// A cantilever with a dashpot c at its tip. w = Re(phi(x) e^(lambda t)) with phi'''' = beta^4 phi, lambda = i
// beta^2 sqrt(EI / rho A), beta complex. At the tip phi'' = 0 and EI phi''' = c lambda phi: a mass c / lambda
// there would give the same force, so that with mu b = (c / lambda) beta / rho A in the equation of the tip
// mass
//
//     1 + cos b cosh b + mu b (cos b sinh b - sin b cosh b) = 0,     b = beta L.
#include <complex>

#include "fem/complex_modes.hpp"
#include "tests/fem/verification/oracle.hpp"

namespace beamid::dashpot_test {
namespace {

using test::bending_stiffness, test::length, test::mass_per_length;
using Complex = std::complex<double>;

const Complex i(0.0, 1.0);

Complex eigenvalue(Complex b) {
  return i * b * b / (length * length) * std::sqrt(bending_stiffness / mass_per_length);
}

// mu b = c L / (rho A lambda L) b / ... = -i c L / (b sqrt(EI rho A))
Complex equation(Complex b, double dashpot) {
  const Complex mu_b = -i * dashpot * length / (b * std::sqrt(bending_stiffness * mass_per_length));
  return 1.0 + cos(b) * cosh(b) + mu_b * (cos(b) * sinh(b) - sin(b) * cosh(b));
}

Complex root(Complex b, double dashpot) {  // Newton's, from the undamped one
  for (int k = 0; k < 50; ++k) {
    const Complex h = 1e-6, slope = (equation(b + h, dashpot) - equation(b - h, dashpot)) / (2.0 * h);
    const Complex step = equation(b, dashpot) / slope;
    b -= step;
    if (std::abs(step) < 1e-15 * std::abs(b)) break;
  }
  return b;
}

TEST(TipDashpot, EigenvaluesAreTheComplexRoots) {
  const double critical = std::sqrt(bending_stiffness * mass_per_length) / length;
  const double undamped[] = {1.8751040687, 4.6940911330, 7.8547574382, 10.9955407349};
  for (const double ratio : {0.02, 0.2}) {
    fem::Beam beam = test::uniform_beam();
    beam.supports = {{0.0, true, true}};
    beam.dashpots = {{length, ratio * critical, 0.0, 0.0}};
    const auto modes = fem::complex_modes(fem::assemble(beam, 200, {}), 4);
    for (int k = 0; k < 4; ++k) {
      const Complex known = eigenvalue(root(undamped[k], ratio * critical));
      EXPECT_LT(known.real(), 0.0);
      test::record("finite_elements", std::abs(modes.eigenvalue[k] / known - 1.0));
      test::record("damping_ratio", modes.damping_ratio()[k] / (-known.real() / std::abs(known)) - 1.0);
      EXPECT_NEAR(std::abs(modes.eigenvalue[k] / known - 1.0), 0.0, 1e-7)
          << "ratio " << ratio << ", mode " << k + 1;
      // the damping ratio is a small part of the eigenvalue and has its own digits
      EXPECT_NEAR(modes.damping_ratio()[k] / (-known.real() / std::abs(known)), 1.0, 1e-6);
    }
  }
}

}  // namespace
}  // namespace beamid::dashpot_test
