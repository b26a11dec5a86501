// Timoshenko's beam with rotary inertia: S = kappa G A, j = rho I, m = rho A,
//
//     S (w' - theta)' + omega^2 m w = 0       EI theta'' + S (w' - theta) + omega^2 j theta = 0.
#include <numbers>

#include "tests/fem/verification/oracle.hpp"

namespace beamid::timoshenko_test {
namespace {

using std::numbers::pi;
using test::bending_stiffness, test::length, test::mass_per_length;

constexpr double shear_stiffness = 900.0, rotary_inertia = 0.007;  // L/h about 5

fem::Beam thick_beam(std::vector<fem::Support> supports, double shear = shear_stiffness) {
  fem::Beam beam = test::uniform_beam();
  beam.segments[0].section.shear_stiffness = shear;
  beam.segments[0].section.rotary_inertia = rotary_inertia;
  beam.supports = std::move(supports);
  return beam;
}

TEST(Timoshenko, PinnedPinned) {
  // w = sin k x, theta = c cos k x, k = n pi / L satisfies the ends and leaves
  //     m j omega^4 - (m (EI k^2 + S) + j S k^2) omega^2 + EI S k^4 = 0.
  std::vector<double> known;
  for (int n = 1; n <= 4; ++n) {
    const double k2 = std::pow(n * pi / length, 2), s = shear_stiffness;
    const double a = mass_per_length * rotary_inertia;
    const double b = mass_per_length * (bending_stiffness * k2 + s) + rotary_inertia * s * k2;
    const double c = bending_stiffness * s * k2 * k2;
    known.push_back(std::sqrt(2.0 * c / (b + std::sqrt(b * b - 4.0 * a * c))));
  }
  test::expect_frequencies(thick_beam({{0.0, true, false}, {length, true, false}}), known);
}

// Waves e^(lambda x) with lambda^2 = a^2 and -d^2 (below the cut-off omega^2 = S / j). With alpha = (S a^2 +
// omega^2 m) / (S a) and delta = (S d^2 - omega^2 m) / (S d), the motions clamped at the root are
//     w = cosh a x - cos d x,                      theta = alpha sinh a x + delta sin d x;
//     w = sinh a x - (alpha / delta) sin d x,      theta = alpha (cosh a x - cos d x).
// At the tip theta' = 0 and w' - theta = 0.
std::vector<double> cantilever_frequencies(int count) {
  const double s = shear_stiffness;
  const auto equation = [&](double omega) {
    const double inertia = omega * omega * mass_per_length, turning = omega * omega * rotary_inertia;
    // EI S lambda^4 + (EI inertia + S turning) lambda^2 - (S - turning) inertia = 0
    const double p = 0.5 * (inertia / s + turning / bending_stiffness);
    const double q = (s - turning) * inertia / (s * bending_stiffness), root = std::sqrt(p * p + q);
    const double d = std::sqrt(root + p), a = std::sqrt(q) / d;
    const double alpha = a + inertia / (s * a), delta = d - inertia / (s * d);
    const double cosh = std::cosh(a * length), sinh = std::sinh(a * length);
    const double cos = std::cos(d * length), sin = std::sin(d * length);
    const double moment_1 = alpha * a * cosh + delta * d * cos, moment_2 = alpha * (a * sinh + d * sin);
    const double shear_1 = (a - alpha) * sinh + (d - delta) * sin;
    const double shear_2 = (a - alpha) * cosh - alpha * (d / delta - 1.0) * cos;
    return (moment_1 * shear_2 - moment_2 * shear_1) / (cosh * omega * omega);
  };
  return test::roots(equation, count, 0.01);
}

TEST(Timoshenko, Cantilever) {
  test::expect_frequencies(thick_beam({{0.0, true, true}}), cantilever_frequencies(4));
}

TEST(Timoshenko, ExactModesGoOnAboveTheCutOffFrequency) {
  // Oracle: pinned-pinned, both roots of the quadratic above for every n, and omega^2 = S / j, the motion
  // theta = const; sorted, they are the spectrum. Modes 1 to 40 span the cut-off.
  std::vector<double> known{std::sqrt(shear_stiffness / rotary_inertia)};
  for (int n = 1; n <= 60; ++n) {
    const double k2 = std::pow(n * pi / length, 2), s = shear_stiffness;
    const double a = mass_per_length * rotary_inertia;
    const double b = mass_per_length * (bending_stiffness * k2 + s) + rotary_inertia * s * k2;
    const double c = bending_stiffness * s * k2 * k2, root = std::sqrt(b * b - 4.0 * a * c);
    known.push_back(std::sqrt(2.0 * c / (b + root)));
    known.push_back(std::sqrt(0.5 * (b + root) / a));
  }
  std::sort(known.begin(), known.end());
  const auto exact = fem::exact_modes(thick_beam({{0.0, true, false}, {length, true, false}}), 40, {});
  for (int i = 0; i < 40; ++i)
    EXPECT_NEAR(exact->angular_frequency[i] / known[i], 1.0, 1e-12) << "mode " << i + 1;
  EXPECT_GT(exact->angular_frequency[39], std::sqrt(shear_stiffness / rotary_inertia));
}

TEST(Timoshenko, DoesNotLockInTheSlenderLimit) {
  // Oracle: without shear and rotary inertia left, Euler-Bernoulli's root 1.8751. A locking element would be
  // far too stiff; this one is, with 1 to 8 elements, better than Euler-Bernoulli's own, its interior shape
  // being a quartic.
  fem::Beam slender = test::uniform_beam();
  slender.supports = {{0.0, true, true}};
  const fem::Beam thin = slender;
  slender.segments[0].section.shear_stiffness = 1e12;
  const double known = test::angular_frequency(1.8751040687119611664);
  for (const int elements : {1, 2, 4, 8}) {
    const auto error = [&](const fem::Beam& beam) {
      return fem::modes(fem::assemble(beam, elements, {}), 1).angular_frequency[0] / known - 1.0;
    };
    EXPECT_LT(std::abs(error(slender)), 0.1 * error(thin)) << elements;
  }
}

TEST(Timoshenko, FewElementsSuffice) {
  // Oracle: the frequency equation above; how far 1 to 8 elements are off the first frequency.
  const double known = cantilever_frequencies(1)[0];
  for (const auto& [elements, error] : {std::pair{1, 1e-3}, {2, 5e-5}, {4, 3e-6}, {8, 2e-7}})
    EXPECT_NEAR(
        fem::modes(fem::assemble(thick_beam({{0.0, true, true}}), elements, {}), 1).angular_frequency[0] /
            known,
        1.0, error);
}

TEST(Timoshenko, LumpedMassHasNoInteriorCoordinates) {
  // Oracle: the frequency equation above, approached with order two from below.
  fem::Beam beam = thick_beam({{0.0, true, true}});
  beam.mass_model = fem::MassModel::lumped;
  const double known = cantilever_frequencies(1)[0];
  const auto error = [&](int elements) {
    const auto system = fem::assemble(beam, elements, {});
    EXPECT_EQ(system.size(), 2 * elements);
    return fem::modes(system, 1).angular_frequency[0] / known - 1.0;
  };
  EXPECT_NEAR(error(20) / error(40), 4.0, 0.1);
}

TEST(Timoshenko, AxialLoadActsOnTheSlopeOfTheAxis) {
  // Oracle: Engesser's buckling load P = P_E / (1 + P_E / S) of the pinned-pinned column, and below it, with
  // w = sin k x in S (w' - theta)' - P w'' + omega^2 m w = 0 and the second equation,
  //     (EI k^2 + S - omega^2 j)((S - P) k^2 - omega^2 m) = S^2 k^2.
  const double euler = pi * pi * bending_stiffness / (length * length);
  const double buckling = euler / (1.0 + euler / shear_stiffness), k2 = pi * pi / (length * length);
  for (const double ratio : {0.9, 0.5, -2.0}) {
    fem::Beam beam = thick_beam({{0.0, true, false}, {length, true, false}});
    beam.axial_load = ratio * buckling;
    const double s = shear_stiffness, a = mass_per_length * rotary_inertia, load = beam.axial_load;
    const double b = mass_per_length * (bending_stiffness * k2 + s) + rotary_inertia * (s - load) * k2;
    const double c = (bending_stiffness * k2 + s) * (s - load) * k2 - s * s * k2;
    test::expect_frequencies(beam, {std::sqrt(2.0 * c / (b + std::sqrt(b * b - 4.0 * a * c)))});
  }
  fem::Beam beam = thick_beam({{0.0, true, false}, {length, true, false}});
  beam.axial_load = 1.0001 * buckling;
  EXPECT_THROW(fem::exact_modes(beam, 1, {}), std::runtime_error);
}

TEST(Timoshenko, RotaryInertiaAloneIsRayleighsBeam) {
  // w = sin k x: omega^2 = EI k^4 / (m + j k^2).
  fem::Beam beam = test::uniform_beam();
  beam.supports = {{0.0, true, false}, {length, true, false}};
  beam.segments[0].section.rotary_inertia = rotary_inertia;
  std::vector<double> known;
  for (int n = 1; n <= 4; ++n) {
    const double k = n * pi / length;
    known.push_back(k * k * std::sqrt(bending_stiffness / (mass_per_length + rotary_inertia * k * k)));
  }
  test::expect_frequencies(beam, known);
}

}  // namespace
}  // namespace beamid::timoshenko_test
