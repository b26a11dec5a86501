// Guyan, improved reduced system, SEREP, Craig and Bampton.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "fem/stiffness_solver.hpp"
#include "reduction/reduction.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::condensation_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using reduction::reduction_registry;
using List = std::vector<double>;

reduction::ReducedModel reduced(const fem::StructuralSystem& system, const std::string& name,
                                const filters::Options& options) {
  return reduce(system, *reduction_registry().make(name, options));
}

// Assembled matrices, in the order masters, slaves.
struct Partition {
  std::vector<Index> order;
  MatrixXd mass, stiffness;
  Index masters;

  Partition(const fem::StructuralSystem& system, const std::vector<double>& positions)
      : masters(static_cast<Index>(positions.size())) {
    std::vector<Index> slaves;
    for (const double x : positions)
      for (Index i = 0; i < system.size(); ++i)
        if (system.coordinates[i].kind == fem::Coordinate::Kind::deflection &&
            std::abs(system.coordinates[i].position - x) < 1e-9)
          order.push_back(i);
    for (Index i = 0; i < system.size(); ++i)
      if (std::find(order.begin(), order.end(), i) == order.end()) slaves.push_back(i);
    order.insert(order.end(), slaves.begin(), slaves.end());
    mass = MatrixXd(system.mass)(order, order);
    stiffness = MatrixXd(system.stiffness.assembled())(order, order);
  }

  // T = [I; -K_ss^-1 K_sm]
  MatrixXd guyan() const {
    const Index slaves = stiffness.rows() - masters;
    MatrixXd shapes(stiffness.rows(), masters);
    shapes << MatrixXd::Identity(masters, masters), -stiffness.bottomRightCorner(slaves, slaves)
                                                         .ldlt()
                                                         .solve(stiffness.bottomLeftCorner(slaves, masters));
    return shapes;
  }

  // T + S M T M_R^-1 K_R
  MatrixXd irs() const {
    const Index n = stiffness.rows(), slaves = n - masters;
    const MatrixXd shapes = guyan();
    MatrixXd inner = MatrixXd::Zero(n, n);
    inner.bottomRightCorner(slaves, slaves) = stiffness.bottomRightCorner(slaves, slaves).inverse();
    const MatrixXd reduced_mass = shapes.transpose() * mass * shapes,
                   reduced_stiffness = shapes.transpose() * stiffness * shapes;
    return shapes + inner * mass * shapes * reduced_mass.inverse() * reduced_stiffness;
  }
};

TEST(Guyan, IsTheCondensationOfTheAssembledMatrices) {
  // Oracle: -K_ss^-1 K_sm of the assembled matrix, a second way.
  const auto system = assemble(test::steel_beam(0.36049), 8);
  const List masters = {0.55, 1.1};
  const auto model = reduced(system, "guyan", {{"masters_m", masters}});
  const Partition partition(system, masters);
  EXPECT_LT((model.shapes(partition.order, Eigen::all) - partition.guyan()).norm(), 1e-10);
}

TEST(Guyan, WithTheTipForMasterIsRayleighsStaticShape) {
  const fem::Cantilever beam = test::steel_beam(0.36049);
  const auto model = reduced(assemble(beam, 30), "guyan", {});
  EXPECT_NEAR(model.system.mass.coeff(0, 0), 33.0 / 140.0 * beam.mass() + beam.tip_mass, 1e-10);
  EXPECT_NEAR(static_stiffness(model.system) / beam.tip_stiffness(), 1.0, 1e-10);
}

TEST(Guyan, KeepsItsDigitsOnAFineMesh) {
  // Oracle: 12 masters that are nodes of a mesh of 24 elements and of one of 1200 see the same stiffness, as
  // shapes under forces at nodes are the same on both.
  List masters;
  for (int i = 1; i <= 12; ++i) masters.push_back(1.1 * i / 12.0);
  const fem::Cantilever beam = test::steel_beam(0.0);
  const MatrixXd
      coarse = reduced(assemble(beam, 24), "guyan", {{"masters_m", masters}}).system.stiffness.assembled(),
      fine = reduced(assemble(beam, 1200), "guyan", {{"masters_m", masters}}).system.stiffness.assembled();
  EXPECT_LT((fine - coarse).norm(), 1e-7 * coarse.norm());
  const VectorXd soft = Eigen::SelfAdjointEigenSolver<MatrixXd>(coarse).eigenvalues(),
                 same = Eigen::SelfAdjointEigenSolver<MatrixXd>(fine).eigenvalues();
  EXPECT_NEAR(same[0] / soft[0], 1.0, 1e-7);
}

TEST(Guyan, ManyMastersConvergeToTheContinuumFromAbove) {
  // Oracle: exact frequency of S(11.8), 3.455527194845 Hz; errors fall as masters are added.
  double last = 1.0;
  for (const int count : {1, 2, 4, 8, 60}) {
    List masters;
    for (int i = 1; i <= count; ++i) masters.push_back(1.1 * i / count);
    const auto model = reduced(assemble(test::steel_beam(0.360490), 120), "guyan", {{"masters_m", masters}});
    const double error = fem::modes(model.system, 1).frequency_hz()[0] / 3.455527194845 - 1.0;
    EXPECT_GT(error, -1e-9);
    EXPECT_LT(error, last);
    last = error;
  }
  EXPECT_LT(last, 1e-8);
}

TEST(Guyan, SnapsToNodesAndRefusesTheRest) {
  const auto system = assemble(test::steel_beam(0.0), 10);
  const auto at_node = reduced(system, "guyan", {{"masters_m", List{0.55, 1.1}}});
  const auto near = reduced(system, "guyan", {{"masters_m", List{0.56, 1.08}}});
  EXPECT_EQ((near.shapes - at_node.shapes).norm(), 0.0);
  const auto message = [&](const List& masters) -> std::string {
    try {
      reduced(system, "guyan", {{"masters_m", masters}});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({1.3}), "reduction 'guyan': position 1.3 m is off the beam; expected 0 to 1.1 m");
  EXPECT_EQ(message({0.02}),
            "reduction 'guyan': the node nearest to 0.02 m, at 0 m, is held by a support; expected one that "
            "can move");
  EXPECT_NE(message({0.55, 0.56}).find("and so is one before"), std::string::npos);
  EXPECT_NE(message({std::nan("")}).find("off the beam"), std::string::npos);
}

TEST(Guyan, CountsOutputsAtOnePlaceOnceAndSkipsStrains) {
  auto system = assemble(test::steel_beam(0.0), 10, {{"a", 0.55}, {"same", 0.55}, {"tip", 1.1}});
  MatrixXd outputs = MatrixXd(system.outputs);
  outputs.conservativeResize(4, Eigen::NoChange);
  outputs.row(3) = outputs.row(0) - outputs.row(2);  // reads two deflections
  system.outputs = outputs.sparseView();
  EXPECT_EQ(reduced(system, "guyan", {}).system.size(), 2);
  system.outputs = MatrixXd(outputs.row(3)).sparseView();
  EXPECT_THROW(reduced(system, "guyan", {}), std::invalid_argument);
}

TEST(Guyan, SaysThatOneMasterDoesNotHoldAFreeBeam) {
  fem::Beam beam = test::steel_beam(0.0);
  beam.supports.clear();
  try {
    reduced(assemble(beam, 10), "guyan", {});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("in 2 ways, and the 1 points given do not hold them all"),
              std::string::npos)
        << error.what();
  }
}

TEST(ImprovedReducedSystem, IsTheFormulaOfItsAuthor) {
  // Oracle: T + S M T M_R^-1 K_R of assembled matrices [ocallahan1989], a second way.
  const auto system = assemble(test::steel_beam(0.36049), 8);
  const List masters = {0.55, 1.1};
  const auto model = reduced(system, "irs", {{"masters_m", masters}});
  const Partition partition(system, masters);
  const MatrixXd published = partition.irs();
  EXPECT_LT((model.shapes(partition.order, Eigen::all) - published).norm(), 1e-9 * published.norm());
}

TEST(ImprovedReducedSystem, WithoutIterationIsGuyans) {
  const auto system = assemble(test::steel_beam(0.36049), 8);
  const auto guyan = reduced(system, "guyan", {{"masters_m", List{0.55, 1.1}}});
  const auto irs = reduced(system, "irs", {{"masters_m", List{0.55, 1.1}}, {"iterations", 0.0}});
  EXPECT_EQ((guyan.shapes - irs.shapes).norm(), 0.0);
}

TEST(ImprovedReducedSystem, IteratedConvergesToSerep) {
  // Oracle: what [friswell1995] proves, the frequencies and shapes of SEREP; here 3 masters.
  const auto system = assemble(test::steel_beam(0.36049), 20);
  const List masters = {0.44, 0.77, 1.1};
  const auto serep = reduced(system, "serep", {{"masters_m", masters}});
  const VectorXd exact = fem::modes(system, 3).angular_frequency;
  double last = 1e300, unlike_serep = 0.0;
  for (const double iterations : {0.0, 1.0, 3.0, 10.0, 60.0}) {
    const auto model = reduced(system, "irs", {{"masters_m", masters}, {"iterations", iterations}});
    const VectorXd found = fem::modes(model.system, 3).angular_frequency;
    const double error = (found - exact).cwiseQuotient(exact).cwiseAbs().maxCoeff();
    EXPECT_LT(error, std::max(last, 1e-11)) << iterations;
    last = error;
    unlike_serep = (model.shapes - serep.shapes).norm() / serep.shapes.norm();
  }
  EXPECT_LT(unlike_serep, 1e-9);
  EXPECT_LT(last, 1e-10);
}

TEST(Serep, CoordinatesAreTheMasters) {
  const auto system = assemble(test::steel_beam(0.36049), 20, {{"a", 0.44}, {"tip", 1.1}});
  const auto model = reduced(system, "serep", {});
  EXPECT_LT((MatrixXd(model.system.outputs) - MatrixXd::Identity(2, 2)).norm(), 1e-12);
}

TEST(Serep, KeepsFewerModesThanMastersExactly) {
  // Oracle: the full system's frequencies and shapes.
  const auto system = assemble(test::steel_beam(0.36049), 20);
  const auto model = reduced(system, "serep", {{"masters_m", List{0.33, 0.66, 1.1}}, {"modes", 2.0}});
  const fem::Modes full = fem::modes(system, 2), small = fem::modes(model.system, 2);
  for (Index i = 0; i < 2; ++i)
    EXPECT_NEAR(small.angular_frequency[i] / full.angular_frequency[i], 1.0, 1e-12);
  EXPECT_THROW(reduced(system, "serep", {{"modes", 2.0}}), std::invalid_argument);  // one master
}

TEST(Serep, RefusesMastersThatDoNotTellModesApart) {
  // Oracle: behind a clamp in the middle the first half sees nothing of the other one's modes, of which the
  // lowest is one.
  fem::Beam beam = test::steel_beam(0.0);
  beam.supports = {{0.0, true, true}, {0.55, true, true}};
  EXPECT_NO_THROW(reduced(assemble(beam, 12, {{"beyond", 0.8}}), "serep", {}));
  EXPECT_THROW(reduced(assemble(beam, 12, {{"before", 0.3}}), "serep", {}), std::invalid_argument);
}

TEST(CraigBampton, FixedInterfaceModesOfTheTipAreThoseOfAClampedBeam) {
  // Oracle: clamped at both ends, beta L = 4.730040744862704 [blevins1979].
  const fem::Cantilever beam = test::steel_beam(0.36049);
  const auto model = reduced(assemble(beam, 60), "craig_bampton", {});
  ASSERT_EQ(model.system.size(), 3);
  const MatrixXd stiffness = model.system.stiffness.assembled(), mass = model.system.mass;
  const double exact =
      std::pow(4.730040744862704 / beam.length, 2) * std::sqrt(beam.bending_stiffness / beam.mass_per_length);
  EXPECT_NEAR(std::sqrt(stiffness(2, 2) / mass(2, 2)) / exact, 1.0, 1e-6);
  EXPECT_LT(stiffness.col(2).head(2).norm(), 1e-9 * stiffness(2, 2));  // they do no work on each other
}

TEST(CraigBampton, KeepsTheInterfaceAsItIs) {
  // Oracle: a middle node's deflection and rotation are coordinates; the static stiffness there is exact.
  const auto system = assemble(test::steel_beam(0.36049), 20, {{"middle", 0.55}});
  const auto model = reduced(system, "craig_bampton", {{"interface_m", List{0.55, 1.1}}, {"modes", 0.0}});
  ASSERT_EQ(model.system.size(), 4);
  EXPECT_LT((MatrixXd(model.system.outputs) - MatrixXd::Identity(1, 4)).norm(), 1e-12);
  EXPECT_NEAR(static_stiffness(model.system) / static_stiffness(system), 1.0, 1e-10);
}

TEST(CraigBampton, OfWholePairsOfEqualModesErrsAsDocumented) {
  // Oracle: dense assembled matrices of 40 elements, Phi = [I 0; -K_ii^-1 K_ib U_i], a second way. The middle
  // is held in deflection and rotation, so that both halves have the same modes: an odd number of them would
  // hold one of two equal ones. docs/theory/reduction.md has the numbers of 1000 elements.
  const auto first_two = [](int elements, double modes) {
    const auto system = assemble(test::steel_beam(0.360490), elements);
    const auto model = reduced(system, "craig_bampton", {{"interface_m", List{0.55, 1.1}}, {"modes", modes}});
    return VectorXd(
        fem::modes(model.system, 2).angular_frequency.cwiseQuotient(fem::modes(system, 2).angular_frequency) -
        VectorXd::Ones(2));
  };
  const auto system = assemble(test::steel_beam(0.360490), 40);
  std::vector<Index> held, inner;
  for (Index i = 0; i < system.size(); ++i) {
    const double x = system.coordinates[i].position;
    (std::abs(x - 0.55) < 1e-9 || std::abs(x - 1.1) < 1e-9 ? held : inner).push_back(i);
  }
  ASSERT_EQ(held.size(), 4u);
  const MatrixXd mass(system.mass), stiffness = system.stiffness.assembled();
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> fixed(stiffness(inner, inner), mass(inner, inner)),
      full(stiffness, mass);
  for (const Index pair : {0, 2, 4})
    EXPECT_NEAR(fixed.eigenvalues()[pair + 1] / fixed.eigenvalues()[pair], 1.0, 1e-8);
  for (const Index modes : {4, 6}) {
    MatrixXd shapes = MatrixXd::Zero(system.size(), 4 + modes);
    for (Index i = 0; i < 4; ++i) shapes(held[static_cast<std::size_t>(i)], i) = 1.0;
    shapes(inner, Eigen::seqN(0, 4)) = -stiffness(inner, inner).ldlt().solve(stiffness(inner, held));
    shapes(inner, Eigen::seqN(4, modes)) = fixed.eigenvectors().leftCols(modes);
    const MatrixXd small_mass = shapes.transpose() * mass * shapes,
                   small_stiffness = shapes.transpose() * stiffness * shapes;
    const VectorXd squares =
        Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(small_stiffness, small_mass).eigenvalues();
    const VectorXd found = first_two(40, static_cast<double>(modes));
    for (Index i = 0; i < 2; ++i)
      EXPECT_NEAR(found[i], std::sqrt(squares[i] / full.eigenvalues()[i]) - 1.0, 1e-9 + 1e-3 * found[i]);
  }
  const VectorXd four = first_two(1000, 4.0), six = first_two(1000, 6.0);
  EXPECT_NEAR(four[0], 1.69e-6, 5e-9);
  EXPECT_NEAR(four[1], 5.69e-5, 5e-8);
  EXPECT_NEAR(six[0], 2.09e-7, 5e-10);
  EXPECT_NEAR(six[1], 2.69e-5, 5e-8);
}

TEST(CraigBampton, OfEveryCoordinateIsNoReduction) {
  const auto system = assemble(test::steel_beam(0.36049), 4);
  List everywhere;
  for (int i = 1; i <= 4; ++i) everywhere.push_back(1.1 * i / 4.0);
  const auto model = reduced(system, "craig_bampton", {{"interface_m", everywhere}, {"modes", 0.0}});
  const VectorXd full = fem::modes(system, 8).angular_frequency,
                 same = fem::modes(model.system, 8).angular_frequency;
  EXPECT_LT((full - same).cwiseQuotient(full).norm(), 1e-10);
  EXPECT_THROW(reduced(system, "craig_bampton", {{"interface_m", everywhere}}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::condensation_test
