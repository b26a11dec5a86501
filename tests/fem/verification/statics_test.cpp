// Static deflections: the shape functions hold every solution without load between the nodes, the flexibility
// is exact, and consistent nodal forces do the work of a distributed load, so that nodes are exact on any
// mesh.
#include "fem/stiffness_solver.hpp"
#include "tests/fem/verification/oracle.hpp"

namespace beamid::statics_test {
namespace {

using test::length;
constexpr double force = 2.4, load = 1.7, stiffness = test::bending_stiffness;

// Deflection at every node under a force at x.
struct Solution {
  Eigen::VectorXd positions, deflection;
  double at(double x) const {
    Eigen::Index node = 0;
    (positions.array() - x).abs().minCoeff(&node);
    return deflection[node];
  }
};

Solution under_force(const fem::Beam& beam, double x, int elements) {
  const auto system = fem::assemble(beam, elements, {{"here", x}});
  const Eigen::VectorXd f = force * Eigen::VectorXd(system.inputs.col(0));
  const Eigen::VectorXd q = fem::StiffnessSolver(system.stiffness).solve(f);
  return {system.mesh.positions(), fem::nodal_deflection(system, q)};
}

// A uniform load, in consistent forces: those of an acceleration of the base, -M 1, per mass per length.
Solution under_uniform_load(const fem::Beam& beam, int elements) {
  const auto system = fem::assemble(beam, elements, {});
  const Eigen::VectorXd f = -load / test::mass_per_length * Eigen::VectorXd(system.inputs.col(0));
  const Eigen::VectorXd q = fem::StiffnessSolver(system.stiffness).solve(f);
  return {system.mesh.positions(), fem::nodal_deflection(system, q)};
}

void expect_deflection(double deflection, double known, double tolerance = 1e-12) {
  test::record("finite_elements", deflection / known - 1.0);
  EXPECT_NEAR(deflection / known, 1.0, tolerance);
}

// At every node that moves, against the known deflection.
template <class Known>
void expect_deflections(const Solution& solution, const Known& known, double tolerance = 1e-12) {
  for (Eigen::Index i = 0; i < solution.positions.size(); ++i)
    if (solution.deflection[i] != 0.0)
      expect_deflection(solution.deflection[i], known(solution.positions[i]), tolerance);
}

const fem::Support clamped_root{0.0, true, true}, clamped_tip{length, true, true};
const fem::Support pinned_root{0.0, true, false}, pinned_tip{length, true, false};
constexpr double cube = length * length * length;

TEST(Statics, CantileverUnderATipForce) {
  for (const int elements : {1, 7, 400})
    expect_deflections(under_force(test::uniform_beam({clamped_root}), length, elements),
                       [](double x) { return force * x * x * (3 * length - x) / (6 * stiffness); });
}

TEST(Statics, CantileverUnderUniformLoad) {
  expect_deflections(under_uniform_load(test::uniform_beam({clamped_root}), 9), [](double x) {
    return load * x * x * (6 * length * length - 4 * length * x + x * x) / (24 * stiffness);
  });
}

TEST(Statics, ClampedClampedUnderAForceAtMidspan) {  // F L^3 / 192 EI
  const auto solution = under_force(test::uniform_beam({clamped_root, clamped_tip}), 0.5 * length, 6);
  expect_deflection(solution.at(0.5 * length), force * cube / (192 * stiffness));
}

TEST(Statics, ClampedClampedUnderAnEccentricForce) {  // F a^3 b^3 / 3 EI L^3 under it
  const double a = 0.3 * length, b = length - a;
  const auto solution = under_force(test::uniform_beam({clamped_root, clamped_tip}), a, 5);
  expect_deflection(solution.at(a), force * std::pow(a * b / length, 3) / (3 * stiffness));
}

TEST(Statics, ProppedCantileverUnderUniformLoad) {
  expect_deflections(
      under_uniform_load(test::uniform_beam({clamped_root, pinned_tip}), 8),
      [](double x) {
        return load * x * x * (3 * length * length - 5 * length * x + 2 * x * x) / (48 * stiffness);
      },
      1e-11);
}

TEST(Statics, TwoEqualSpansUnderUniformLoad) {
  // Oracle: by symmetry each span is a propped cantilever, clamped at the middle support.
  const double span = 0.5 * length;
  expect_deflections(
      under_uniform_load(test::uniform_beam({pinned_root, {span, true, false}, pinned_tip}), 8),
      [&](double at) {
        const double x = std::min(at, length - at);
        return load * x * (std::pow(span, 3) - 3 * span * x * x + 2 * x * x * x) / (48 * stiffness);
      },
      1e-11);
}

TEST(Statics, WidthTaper) {
  // EI = EI_0 (1 - c s): the tip sinks by F L^3 / EI_0 times the integral of (1 - s)^2 / (1 - c s) over 0..1,
  // which with k = (1 - c) / c is (1/2 - k + k^2 log(1 + 1/k)) / c.
  for (const double c : {0.3, 0.8}) {
    fem::Beam beam = test::uniform_beam({clamped_root});
    beam.segments[0].section.bending_stiffness = fem::Variation::linear(stiffness, (1 - c) * stiffness);
    const double k = (1 - c) / c, known = (0.5 - k + k * k * std::log1p(1 / k)) / c;
    for (const int elements : {1, 8})
      expect_deflection(under_force(beam, length, elements).at(length), force * cube / stiffness * known);
  }
}

TEST(Statics, WedgeThatIsCutOff) {
  // EI = EI_0 (1 - c s)^3: the integral of (1 - s)^2 / (1 - c s)^3; with u = 1 - c s and 1 - s = (u - (1 -
  // c)) / c it is (-log(1 - c) - 2 (1 - c) (1/(1 - c) - 1) + (1 - c)^2 (1/(1 - c)^2 - 1) / 2) / c^3.
  const double c = 0.6, rest = 1 - c;
  const auto height = fem::Variation::linear(1.0, rest);
  fem::Beam beam = test::uniform_beam({clamped_root});
  beam.segments[0].section.bending_stiffness = height * height * height * fem::Variation(stiffness);
  const double known = (-std::log(rest) - 2 * (1 - rest) + 0.5 * (1 - rest * rest)) / (c * c * c);
  for (const int elements : {1, 8})
    expect_deflection(under_force(beam, length, elements).at(length), force * cube / stiffness * known);
}

TEST(Statics, ShearAddsItsOwnDeflection) {  // F L^3 / 3 EI + F L / kappa G A
  const double shear = 60.0;
  fem::Beam beam = test::uniform_beam({clamped_root});
  beam.segments[0].section.shear_stiffness = shear;
  for (const int elements : {1, 5})
    expect_deflection(under_force(beam, length, elements).at(length),
                      force * (cube / (3 * stiffness) + length / shear));
}

TEST(Statics, ShearUnderUniformLoad) {  // at the tip q L^4 / 8 EI + q L^2 / (2 kappa G A)
  const double shear = 60.0;
  fem::Beam beam = test::uniform_beam({clamped_root});
  beam.segments[0].section.shear_stiffness = shear;
  for (const int elements : {1, 5})
    expect_deflection(under_uniform_load(beam, elements).at(length),
                      load * (cube * length / (8 * stiffness) + length * length / (2 * shear)));
}

TEST(Statics, CantileverOnASpring) {  // spring k at the tip: F / (3 EI / L^3 + k)
  fem::Beam beam = test::uniform_beam({clamped_root});
  beam.springs = {{length, 12.0, 0.0, 0.0}};
  expect_deflection(under_force(beam, length, 3).at(length), force / (3 * stiffness / cube + 12.0));
}

TEST(Statics, BeamColumn) {
  // Compressed cantilever with a transverse tip force: w = F / (P k) (tan k L - k L), k^2 = P / EI; the cubic
  // shapes of the axial load are off by (k h)^4.
  const double compression = 2.0, k = std::sqrt(compression / stiffness);
  fem::Beam beam = test::uniform_beam({clamped_root});
  beam.axial_load = compression;
  const double known = force / (compression * k) * (std::tan(k * length) - k * length);
  const auto error = [&](int elements) { return under_force(beam, length, elements).at(length) / known - 1; };
  test::record("finite_elements", error(8));
  EXPECT_LT(std::abs(error(8)), 1e-6);
  EXPECT_NEAR(std::log2(error(4) / error(8)), 4.0, 0.05);
}

}  // namespace
}  // namespace beamid::statics_test
