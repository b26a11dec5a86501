#include "fem/exact/uniform_piece.hpp"

#include <algorithm>
#include <cmath>

namespace beamid::fem {
namespace {

constexpr int terms = 30;  // the eigenvalues of X are below 2, and 2^30/30! is below rounding

}  // namespace

// With the ends held, integral EI theta'^2 + (w' - theta)^2 / phi bounds omega^2 (rho A w^2 + rho I theta^2)
// + P w'^2 from above: integral theta^2 <= (h/pi)^2 integral theta'^2, the same for w, and w'^2 <= 2 theta^2
// + 2 (w' - theta)^2.
double UniformPiece::wave_number(double omega) const {
  const double bending = std::sqrt(omega * std::sqrt(mass_per_length / bending_stiffness));
  const double turning =
      std::sqrt((omega * omega * rotary_inertia + 2.0 * std::abs(axial_load)) / bending_stiffness);
  const double shear = omega * std::sqrt(mass_per_length * shear_flexibility);
  return std::max({bending, turning, shear});
}

Eigen::Matrix4d UniformPiece::rate(double omega, const StateScale& scale) const {
  const double length_2 = scale.length * scale.length, stiffness = scale.bending_stiffness;
  const double chord = 1.0 / (1.0 - shear_flexibility * axial_load);      // w' per theta
  const double drift = chord * shear_flexibility * stiffness / length_2;  // w' per V
  const double load = axial_load * length_2 / stiffness;
  Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
  a(0, 1) = chord;
  a(0, 2) = drift;
  a(1, 3) = stiffness / bending_stiffness;
  a(2, 0) = -omega * omega * mass_per_length * length_2 * length_2 / stiffness;
  a(3, 1) = -load * chord - omega * omega * rotary_inertia * length_2 / stiffness;
  a(3, 2) = -1.0 - load * drift;
  return a;
}

Eigen::Matrix4d transition(const Eigen::Matrix4d& x) {
  Eigen::Matrix4d sum = Eigen::Matrix4d::Identity();
  for (int k = terms; k > 0; --k) sum = Eigen::Matrix4d::Identity() + x * sum / k;
  return sum;
}

HarmonicState advance(const Eigen::Matrix4d& x, const HarmonicState& y) {
  HarmonicState sum = y;
  for (int k = terms; k > 0; --k) sum = y + x * sum / k;
  return sum;
}

}  // namespace beamid::fem
