#include "fem/exact/exact_cantilever.hpp"

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

namespace beamid::fem {
namespace {

using std::cos, std::sin, std::exp;

// The frequency equation divided by cosh b, so that it stays of order one.
double frequency_equation(double b, double mu, double kappa) {
  const double tanh = std::tanh(b), sech = 1.0 / std::cosh(b);
  return sech + cos(b) + mu * b * (cos(b) * tanh - sin(b)) - kappa * b * b * b * (sin(b) + cos(b) * tanh) +
         mu * kappa * b * b * b * b * (sech - cos(b));
}

// Roots in order: scanned in steps far below their spacing (about pi), then bracketed to the last digit.
double find_root(double mu, double kappa, int wanted) {
  constexpr double step = 0.02;
  const auto f = [&](double b) { return frequency_equation(b, mu, kappa); };
  double left = 1e-6, at_left = f(left);
  for (int found = 0;;) {
    const double right = left + step, at_right = f(right);
    if (!std::isfinite(at_right))
      throw std::invalid_argument(
          "exact cantilever: tip mass or inertia beyond double precision beside the beam's");
    if (at_left * at_right <= 0.0 && ++found == wanted) {
      std::uintmax_t iterations = 200;
      const auto tolerance = boost::math::tools::eps_tolerance<double>(52);
      const auto [a, b] =
          boost::math::tools::toms748_solve(f, left, right, at_left, at_right, tolerance, iterations);
      return 0.5 * (a + b);
    }
    left = right;
    at_left = at_right;
  }
}

}  // namespace

ExactMode::ExactMode(const Cantilever& beam, int i) : beam_(beam) {
  validate(beam);
  if (beam.tip_eccentricity != 0.0)
    throw std::invalid_argument("the exact cantilever has no tip eccentricity; expected 0");
  if (i < 1) throw std::invalid_argument("mode is " + std::to_string(i) + "; expected 1 or more");
  const double mu = beam.tip_mass / beam.mass();
  const double kappa = beam.tip_rotary_inertia / (beam.mass() * beam.length * beam.length);
  root_ = find_root(mu, kappa, i);

  // phi = cosh y - cos y - sigma (sinh y - sin y); the moment condition at the tip, phi'' = kappa b^3 phi',
  // gives sigma. Its hyperbolic part is written (1-sigma)/2 e^y + (1+sigma)/2 e^-y with 1 - sigma in closed
  // form: nothing cancels, however high the mode.
  const double b = root_, c = cos(b), s = sin(b), r = kappa * b * b * b;
  const double scaled_cosh = 0.5 * (1.0 + exp(-2.0 * b)),
               scaled_sinh = 0.5 * (1.0 - exp(-2.0 * b));                            // e^-b cosh b
  const double below = scaled_sinh + exp(-b) * s - r * (scaled_cosh - exp(-b) * c);  // e^-b times
  const double above = scaled_cosh + exp(-b) * c - r * (scaled_sinh + exp(-b) * s);
  sigma_ = above / below;
  growing_ = 0.5 * (s - c - exp(-b) - r * (exp(-b) - c - s)) / below;  // (1 - sigma)/2 e^b
  decaying_ = 0.5 * (1.0 + sigma_);

  // Gauss's rule on panels of at most half a wave integrates the shape's square to rounding.
  const int panels = i + 1;
  double integral = 0.0;
  for (int k = 0; k < panels; ++k)
    integral += boost::math::quadrature::gauss<double, 30>::integrate(
        [this](double y) { return unscaled_shape(y) * unscaled_shape(y); }, b * k / panels,
        b * (k + 1) / panels);
  const double tip = unscaled_shape(b), slope = unscaled_slope(b);
  mass_at_tip_ = beam.mass() * (integral / b + kappa * b * b * slope * slope) / (tip * tip) + beam.tip_mass;
}

double ExactMode::angular_frequency() const {
  const double length_2 = beam_.length * beam_.length;
  return root_ * root_ * std::sqrt(beam_.bending_stiffness / (beam_.mass_per_length * length_2 * length_2));
}

double ExactMode::frequency_hz() const {
  return angular_frequency() / (2.0 * std::numbers::pi);
}

double ExactMode::unscaled_shape(double y) const {
  return growing_ * exp(y - root_) + decaying_ * exp(-y) - cos(y) + sigma_ * sin(y);
}

double ExactMode::unscaled_slope(double y) const {
  return growing_ * exp(y - root_) - decaying_ * exp(-y) + sin(y) + sigma_ * cos(y);
}

double ExactMode::shape(double x) const {
  return unscaled_shape(root_ * x / beam_.length) / unscaled_shape(root_);
}

double ExactMode::release_amplitude(double tip_deflection) const {
  const double omega = angular_frequency();
  return beam_.tip_stiffness() * tip_deflection / (omega * omega * mass_at_tip_);
}

}  // namespace beamid::fem
