#include "fem/stiffness_solver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fem/assembly.hpp"
#include "fem/solvers/refined_solver.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::stiffness_solver_test {
namespace {

using Eigen::Index, Eigen::VectorXd;
using fem::StiffnessSolver;

#if defined(__SANITIZE_ADDRESS__)
constexpr int largest_mesh = 50'000;  // elements; instrumented code is slow
#else
constexpr int largest_mesh = 500'000;
#endif

fem::Beam uniform_beam(std::vector<fem::Support> supports) {
  fem::Beam beam;
  beam.segments = {{2.0, {3.0, 1.0, 0.0, {}, {}, {}}}};
  beam.supports = std::move(supports);
  return beam;
}
constexpr double length = 2.0, bending_stiffness = 3.0;

// Segments of their own stiffness, springs, damage, supports inside and at the ends, elements of unequal
// length.
fem::Beam random_beam(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  fem::Beam beam;
  const int segments = 1 + static_cast<int>(3 * unit(random));
  for (int i = 0; i < segments; ++i) {
    fem::Section section{1.0 + 9.0 * unit(random), 1.0, 0.0, {}, {}, {}};
    if (unit(random) < 0.5) section.bending_stiffness = fem::Variation::linear(2.0, 0.5 + unit(random));
    if (unit(random) < 0.3) section.shear_stiffness = 200.0;
    beam.segments.push_back({0.2 + unit(random), section});
  }
  const double end = beam.length();
  beam.damages = {{0.2 * end, 0.3 * end, 0.5 * unit(random)}};
  beam.springs = {{end * unit(random), 20.0 * unit(random), unit(random), 0.0}};
  if (unit(random) < 0.5)
    beam.springs.push_back({0.0, 100.0 * unit(random), 10.0 * unit(random), 0.0});  // an elastic root
  else
    beam.supports.push_back({0.0, true, unit(random) < 0.5});
  if (unit(random) < 0.5)
    beam.supports.push_back({(0.3 + 0.4 * unit(random)) * end, true, unit(random) < 0.2});
  beam.supports.push_back({end, unit(random) < 0.7, unit(random) < 0.5});
  return beam;
}

TEST(StiffnessSolver, SweepsAndSparseFactorsAgreeOnRandomBeams) {
  // Oracle: the mixed system, solved by UMFPACK.
  std::mt19937_64 random(20240607);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 40; ++trial) {
    const auto system = assemble(random_beam(random), 15, {});
    const StiffnessSolver solver(system.stiffness);
    ASSERT_TRUE(solver.is_chain()) << trial;
    ASSERT_EQ(solver.rigid_motions().cols(), 0) << trial;
    VectorXd load(system.size()), q(system.size()), forces(system.stiffness.strain.rows());
    for (double& value : load) value = normal(random);
    fem::MixedSolver(system.stiffness).solve(load, q, forces);
    const auto solution = solver.solve_with_forces(load);
    EXPECT_LT((solution.coordinates - q).norm(), 1e-11 * q.norm()) << trial;
    EXPECT_LT((solution.natural_forces - forces).norm(), 1e-11 * forces.norm()) << trial;
    const VectorXd imbalance = system.stiffness.strain.transpose() * solution.natural_forces - load;
    EXPECT_LT(imbalance.cwiseAbs().maxCoeff(), 1e-12 * forces.cwiseAbs().maxCoeff()) << trial;
    solver.solve_into(load, q, forces);
    EXPECT_LT((solution.coordinates - q).norm(), 1e-11 * q.norm()) << trial;
  }
}

TEST(StiffnessSolver, NaturalForcesOfATipLoadAreShearAndMoment) {
  // Oracle: statics. The drift strain opposes the shear F, the rotation strain carries the moment F (L - x)
  // over h.
  const int elements = 8;
  const auto system = assemble(uniform_beam({{0.0, true, true}}), elements);
  const auto solution =
      StiffnessSolver(system.stiffness).solve_with_forces(5.0 * VectorXd(system.inputs.col(0)));
  for (int e = 0; e < elements; ++e) {
    EXPECT_NEAR(solution.natural_forces[2 * e], -5.0, 1e-14) << e;
    EXPECT_NEAR(solution.natural_forces[2 * e + 1], 5.0 * (elements - 1 - e), 1e-13) << e;
  }
}

TEST(StiffnessSolver, EndMomentsOfAClampedBeamArePLOverEight) {
  const int elements = 10;
  const auto system = assemble(uniform_beam({{0.0, true, true}, {length, true, true}}), elements);
  ASSERT_EQ(system.output_names[0], "midspan_deflection");
  const auto solution = StiffnessSolver(system.stiffness).solve_with_forces(system.inputs.col(0));
  const double h = length / elements;
  EXPECT_NEAR(std::abs(solution.natural_forces[2 * elements - 1]), length / 8.0 / h, 1e-12);
  EXPECT_NEAR((system.outputs * solution.coordinates)[0], std::pow(length, 3) / (192.0 * bending_stiffness),
              1e-14);
}

TEST(StiffnessSolver, DeflectionsOfClassicBeamsAreTheTextbooks) {
  // Oracle: a force in the middle of a pinned beam, P L^3 / 48 EI; of a propped cantilever, 7 P L^3 / 768 EI.
  // At a quarter of the span of two spans over three supports, 23 P l^3 / 1536 EI with spans l.
  const double unit = std::pow(length, 3) / bending_stiffness;
  const auto deflection = [](const fem::Beam& beam, double x) {
    return 1.0 / static_stiffness(assemble(beam, 16, {{"point", x}}));
  };
  EXPECT_NEAR(deflection(uniform_beam({{0.0, true, false}, {length, true, false}}), 1.0), unit / 48.0, 1e-13);
  EXPECT_NEAR(deflection(uniform_beam({{0.0, true, true}, {length, true, false}}), 1.0), 7.0 * unit / 768.0,
              1e-13);
  EXPECT_NEAR(deflection(uniform_beam({{0.0, true, false}, {1.0, true, false}, {length, true, false}}), 0.5),
              23.0 * unit / 8.0 / 1536.0, 1e-13);
}

TEST(StiffnessSolver, TwentySpansAgreeWithSparseFactors) {
  // One long cantilever with twenty redundant supports is a poor basis for twenty short spans: digits are
  // lost.
  std::vector<fem::Support> supports{{0.0, true, true}};
  for (int i = 1; i <= 20; ++i) supports.push_back({length * i / 20.0, true, false});
  const auto system = assemble(uniform_beam(supports), 200, {{"point", 0.525 * length}});
  const StiffnessSolver solver(system.stiffness);
  const VectorXd load = system.inputs.col(0);
  VectorXd q(system.size()), forces(system.stiffness.strain.rows());
  fem::MixedSolver(system.stiffness).solve(load, q, forces);
  EXPECT_LT((solver.solve(load) - q).norm(), 1e-9 * q.norm());
}

TEST(StiffnessSolver, CountsTheRigidMotions) {
  struct Case {
    std::vector<fem::Support> supports;
    std::vector<fem::Spring> springs;
    Index rigid;
  };
  const std::vector<Case> cases = {{{}, {}, 2},
                                   {{{0.0, true, false}}, {}, 1},
                                   {{{0.7, false, true}}, {}, 1},
                                   {{{0.0, false, true}, {length, false, true}}, {}, 1},
                                   {{}, {{0.3, 1.0, 0.0, 0.0}}, 1},
                                   {{}, {{0.3, 1.0, 0.0, 0.0}, {0.3001, 1e-9, 0.0, 0.0}}, 0},
                                   {{}, {{0.3, 0.0, 1.0, 0.0}, {0.5, 0.0, 1.0, 0.0}}, 1},
                                   {{{1.0, true, true}}, {}, 0}};
  for (const auto& [supports, springs, rigid] : cases) {
    fem::Beam beam = uniform_beam(supports);
    beam.springs = springs;
    const auto system = assemble(beam, 1000, {});
    const StiffnessSolver solver(system.stiffness);
    EXPECT_EQ(solver.rigid_motions().cols(), rigid);
    if (rigid > 0) {
      EXPECT_LT((system.stiffness.strain * solver.rigid_motions()).cwiseAbs().maxCoeff(), 1e-13);
    }
  }
}

TEST(StiffnessSolver, BendsAFreeBeamByABalancedLoad) {
  // Oracle: forces 1/2, -1, 1/2 at ends and middle bend it as a force does a pinned beam.
  const auto system = assemble(uniform_beam({}), 20, {{"a", 0.0}, {"b", 0.5 * length}, {"c", length}});
  const StiffnessSolver solver(system.stiffness);
  const VectorXd load = system.inputs.leftCols(3) * Eigen::Vector3d(0.5, -1.0, 0.5);
  const VectorXd y = system.outputs * solver.solve(load);
  EXPECT_NEAR(0.5 * (y[0] + y[2]) - y[1], std::pow(length, 3) / (48.0 * bending_stiffness), 1e-13);
  EXPECT_THROW(solver.solve(VectorXd(system.inputs.col(0))), std::invalid_argument);
}

TEST(StiffnessSolver, SaysHowManyRigidMotionsForbidAStaticSolution) {
  const auto system = assemble(uniform_beam({}), 4, {{"a", 0.0}});
  try {
    static_stiffness(system);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "the structure can move without strain: 2 rigid-body motions");
  }
}

TEST(StiffnessSolver, ABeamWithoutItsFirstElementFloats) {
  auto system = assemble(test::steel_beam(0.0), 2);
  for (const int row : {0, 1})
    for (const int column : {0, 1}) system.stiffness.strain.coeffRef(row, column) = 0.0;
  EXPECT_EQ(StiffnessSolver(system.stiffness).rigid_motions().cols(), 2);
  EXPECT_THROW(static_shape(system), std::runtime_error);
}

TEST(StiffnessSolver, RefusesLoosePartsTooManyToCount) {
  // Sixty pairs of masses, a spring between the two of each: no chain, and nothing holds any of them.
  std::vector<Eigen::Triplet<double>> entries;
  for (int pair = 0; pair < 60; ++pair) {
    entries.emplace_back(pair, 2 * pair, -0.3);
    entries.emplace_back(pair, 2 * pair + 1, 0.3);
  }
  fem::StrainFactors stiffness{fem::SparseMatrix(60, 120), fem::SparseMatrix(60, 60),
                               fem::SparseMatrix(60, 60)};
  stiffness.strain.setFromTriplets(entries.begin(), entries.end());
  stiffness.rigidity.setIdentity();
  stiffness.flexibility.setIdentity();
  EXPECT_THROW(StiffnessSolver{stiffness}, std::runtime_error);
}

TEST(StiffnessSolver, AxialLoadSoftensACantileverAsBeamColumnsDo) {
  // Oracle: F / delta = P / (tan(k L) / k - L), k^2 = P / EI; tanh in tension. Cubics err by (k h)^4.
  for (const double load : {0.5, -4.0}) {
    fem::Beam beam = uniform_beam({{0.0, true, true}});
    beam.axial_load = load;
    const auto system = assemble(beam, 100);
    EXPECT_FALSE(StiffnessSolver(system.stiffness).is_chain());
    const double k = std::sqrt(std::abs(load) / bending_stiffness);
    const double exact = load / ((load > 0.0 ? std::tan(k * length) : std::tanh(k * length)) / k - length);
    EXPECT_NEAR(static_stiffness(system) / exact, 1.0, 1e-9) << load;
  }
}

TEST(StiffnessSolver, TipStiffnessOfTheFinestMeshKeepsTwelveDigits) {
  const fem::Cantilever beam = test::steel_beam(0.0);
  EXPECT_NEAR(fem::static_stiffness(assemble(beam, largest_mesh)) / beam.tip_stiffness(), 1.0, 1e-12);
}

}  // namespace
}  // namespace beamid::stiffness_solver_test
