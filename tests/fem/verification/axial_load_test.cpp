// Euler-Bernoulli under an axial load P, positive in compression, that keeps its direction:
// EI w'''' + P w'' = omega^2 rho A w. With w = e^(lambda x): EI lambda^4 + P lambda^2 - omega^2 rho A = 0,
// whose roots are lambda^2 = a^2 and -d^2, d^2 - a^2 = P / EI and (a d)^2 = omega^2 rho A / EI.
#include <numbers>

#include "tests/fem/verification/oracle.hpp"

namespace beamid::axial_load_test {
namespace {

using std::numbers::pi;
using test::bending_stiffness, test::length, test::mass_per_length;

fem::Beam loaded(double axial_load, std::vector<fem::Support> supports) {
  fem::Beam beam = test::uniform_beam();
  beam.supports = std::move(supports);
  beam.axial_load = axial_load;
  return beam;
}

const std::vector<fem::Support> cantilever{{0.0, true, true}};
const std::vector<fem::Support> pinned{{0.0, true, false}, {length, true, false}};
const std::vector<fem::Support> clamped{{0.0, true, true}, {length, true, true}};
const double euler_load = pi * pi * bending_stiffness / (length * length);

// w'' = 0 and EI w''' + P w' = 0 at the tip (the force keeps its direction, the shear force does not) of the
// shapes cosh a x - cos d x and sinh(a x) / a - sin(d x) / d, which are clamped at the root:
//     2 a^2 d^2 + (a^4 + d^4) cosh cos + a d (a^2 - d^2) sinh sin = 0      (arguments a L and d L)
std::vector<double> cantilever_frequencies(double axial_load, int count) {
  const double p = axial_load / bending_stiffness;
  const auto equation = [&](double omega) {
    const double q = omega * omega * mass_per_length / bending_stiffness, root = std::sqrt(0.25 * p * p + q);
    const double d2 = root + 0.5 * p, a2 = root - 0.5 * p;  // q = a^2 d^2
    const double a = std::sqrt(a2) * length, d = std::sqrt(d2) * length;
    return 2.0 * a2 * d2 / std::cosh(a) + (a2 * a2 + d2 * d2) * std::cos(d) +
           std::sqrt(a2 * d2) * (a2 - d2) * std::tanh(a) * std::sin(d);
  };
  return test::roots(equation, count, 0.01);
}

TEST(AxialLoad, PinnedPinned) {
  // w = sin(n pi x / L): omega_n^2 = (n pi / L)^4 EI / rho A (1 - P / (n^2 P_Euler)).
  for (const double ratio : {0.6, -3.0}) {
    std::vector<double> known;
    for (int n = 1; n <= 4; ++n)
      known.push_back(test::angular_frequency(n * pi) * std::sqrt(1.0 - ratio / (n * n)));
    test::expect_frequencies(loaded(ratio * euler_load, pinned), known);
  }
}

TEST(AxialLoad, CantileverInCompression) {
  const double load = 0.8 * 0.25 * euler_load;
  test::expect_frequencies(loaded(load, cantilever), cantilever_frequencies(load, 4));
}

TEST(AxialLoad, CantileverInTension) {
  const double load = -2.0 * euler_load;
  test::expect_frequencies(loaded(load, cantilever), cantilever_frequencies(load, 4));
}

TEST(AxialLoad, ATautBeamIsAString) {
  // Oracle: c = sqrt(T / rho A); clamped ends stiffen the string by 1 + 2 sqrt(EI / T) / L, which exact_modes
  // must reach to second order in that small number.
  const double tension = 1e6, small = std::sqrt(bending_stiffness / tension) / length;
  const auto exact = fem::exact_modes(loaded(-tension, clamped), 3, {});
  for (int n = 1; n <= 3; ++n)
    EXPECT_NEAR(exact->angular_frequency[n - 1] / (n * pi / length * std::sqrt(tension / mass_per_length)),
                1.0 + 2.0 * small, 100.0 * small * small);
}

TEST(AxialLoad, FrequencyVanishesAtTheBucklingLoad) {
  // Oracle: Euler's loads. Near them omega^2 is proportional to the load that is missing: halved with it.
  const struct {
    const char* name;
    std::vector<fem::Support> supports;
    double load;
  } columns[] = {
      {"clamped-free", cantilever, 0.25}, {"pinned-pinned", pinned, 1.0}, {"clamped-clamped", clamped, 4.0}};
  for (const auto& [name, supports, load] : columns) {
    const auto square = [&](double missing, bool exact) {
      const fem::Beam beam = loaded((1.0 - missing) * load * euler_load, supports);
      const double omega = exact ? fem::exact_modes(beam, 1, {})->angular_frequency[0]
                                 : fem::modes(fem::assemble(beam, 200, {}), 1).angular_frequency[0];
      return omega * omega;
    };
    const double unloaded = square(1.0, true);
    for (const bool exact : {true, false}) {
      EXPECT_LT(square(1e-4, exact), 1.1e-4 * unloaded) << name;
      EXPECT_NEAR(square(1e-4, exact) / square(2e-4, exact), 0.5, exact ? 1e-4 : 1e-3) << name;
    }
    EXPECT_THROW(square(-1e-4, true), std::runtime_error) << name;
    EXPECT_THROW(square(-1e-4, false), std::runtime_error) << name;
  }
}

}  // namespace
}  // namespace beamid::axial_load_test
