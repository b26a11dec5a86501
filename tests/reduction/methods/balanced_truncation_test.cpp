// Gramians in closed form against Lyapunov's equation.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <unsupported/Eigen/KroneckerProduct>

#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "reduction/reduction.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::balanced_truncation_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using reduction::reduction_registry;

reduction::Bases balanced(const fem::StructuralSystem& system, double modes, double ratio) {
  return reduction_registry()
      .make("balanced_truncation", {{"modes", modes}, {"damping_ratio", ratio}})
      ->bases(system);
}

// X of A X + X A^T + F = 0.
MatrixXd lyapunov(const MatrixXd& a, const MatrixXd& f) {
  const Index n = a.rows();
  const MatrixXd one = MatrixXd::Identity(n, n);
  const MatrixXd both = Eigen::kroneckerProduct(one, a) + Eigen::kroneckerProduct(a, one);
  const VectorXd x = both.fullPivLu().solve(-f.reshaped());
  return x.reshaped(n, n);
}

TEST(BalancedTruncation, SingularValueOfOneModeIsTheClosedForm) {
  // Oracle: 1 / (4 xi omega^3 m), integral of the squared impulse response. A clamped beam of one element
  // whose tip is guided has one coordinate.
  fem::Beam beam = test::steel_beam(0.0);
  beam.supports.push_back({1.1, false, true});
  const auto system = assemble(beam, 1);
  ASSERT_EQ(system.size(), 1);
  const auto bases = balanced(system, 1.0, 0.02);
  const double omega = fem::modes(system, 1).angular_frequency[0], mass = system.mass.coeff(0, 0);
  EXPECT_NEAR(bases.significance[0] * (4.0 * 0.02 * std::pow(omega, 3) * mass), 1.0, 1e-12);
  EXPECT_EQ(bases.significance_name, "position-velocity singular value [m s/N]");
}

TEST(BalancedTruncation, BalancesPositionAndVelocityGramian) {
  // Oracle: Lyapunov's equations of the first-order system with the same damping, solved densely; in the
  // shapes found both gramians are the diagonal of the singular values. Damped heavily, so that modes
  // overlap.
  const auto system = assemble(test::steel_beam(0.36049), 2, {{"a", 0.55}, {"tip", 1.1}});
  const double ratio = 0.3;
  const Index n = system.size();
  const auto bases = balanced(system, static_cast<double>(n), ratio);

  const fem::Modes modes = fem::modes(system, n);
  const VectorXd square = modes.angular_frequency.cwiseAbs2(), rate = 2.0 * ratio * modes.angular_frequency;
  const MatrixXd seen = system.outputs * modes.shape;
  MatrixXd a = MatrixXd::Zero(2 * n, 2 * n), b = MatrixXd::Zero(2 * n, 2), c = MatrixXd::Zero(2, 2 * n);
  a.topRightCorner(n, n).setIdentity();
  a.bottomLeftCorner(n, n) = -MatrixXd(square.asDiagonal());
  a.bottomRightCorner(n, n) = -MatrixXd(rate.asDiagonal());
  b.bottomRows(n) = seen.transpose();
  c.leftCols(n) = seen;
  const MatrixXd reach = lyapunov(a, b * b.transpose()), sight = lyapunov(a.transpose(), c.transpose() * c);
  const MatrixXd turn = modes.shape.transpose() * (system.mass * bases.shapes);  // modal to balanced
  const MatrixXd position = turn.transpose() * reach.topLeftCorner(n, n) * turn,
                 velocity = turn.transpose() * sight.bottomRightCorner(n, n) * turn,
                 diagonal = bases.significance.asDiagonal();
  EXPECT_LT((turn.transpose() * turn - MatrixXd::Identity(n, n)).norm(), 1e-10);
  EXPECT_LT((position - diagonal).norm(), 1e-7 * diagonal.norm());
  EXPECT_LT((velocity - diagonal).norm(), 1e-7 * diagonal.norm());
}

TEST(BalancedTruncation, LightlyDampedShapesAreTheModesInOrderOfWhatIsSeen) {
  // Oracle: modes far apart decouple, sigma_i = (H phi_i)^2 / (4 xi omega_i^3) [gawronski1998]; the middle of
  // a simply supported beam does not see the even modes, so the second shape is mode 3.
  fem::Beam beam = test::steel_beam(0.0);
  beam.supports = {{0.0, true, false}, {1.1, true, false}};
  const auto system = assemble(beam, 20, {{"middle", 0.55}});
  const auto bases = balanced(system, 2.0, 1e-5);
  const fem::Modes modes = fem::modes(system, 5);
  EXPECT_NEAR(std::abs(modes.shape.col(0).dot(system.mass * bases.shapes.col(0))), 1.0, 1e-8);
  EXPECT_NEAR(std::abs(modes.shape.col(2).dot(system.mass * bases.shapes.col(1))), 1.0, 1e-8);
  const VectorXd seen = (system.outputs * modes.shape).row(0).transpose();
  for (const Index i : {0, 1})
    EXPECT_NEAR(
        bases.significance[i] * 4e-5 * std::pow(modes.angular_frequency[2 * i], 3) / std::pow(seen[2 * i], 2),
        1.0, 1e-6);
}

TEST(BalancedTruncation, SingularValuesFall) {
  // Oracle: a gramian is positive semidefinite, and its eigenvalues are told in order.
  const auto system = assemble(test::steel_beam(0.36049), 20);
  const VectorXd values = balanced(system, 3.0, 0.005).significance;
  for (Index i = 1; i < values.size(); ++i) EXPECT_LE(values[i], values[i - 1]);
  EXPECT_GE(values.minCoeff(), 0.0);
}

TEST(BalancedTruncation, KeepsRigidMotionsBeforeAllOthers) {
  fem::Beam beam = test::steel_beam(0.0);
  beam.supports.clear();
  const auto system = assemble(beam, 20);
  const auto model = reduction::project(system, balanced(system, 4.0, 0.005));
  EXPECT_EQ(fem::modes(model.system, 4).rigid, 2);
  const auto few = reduction::project(system, balanced(system, 1.0, 0.005));
  EXPECT_EQ(fem::modes(few.system, 1).rigid, 1);
}

TEST(BalancedTruncation, RefusesImpossibleDamping) {
  const auto system = assemble(test::steel_beam(0.0), 4);
  for (const double ratio : {0.0, -0.1, 1.0, std::nan("")})
    EXPECT_THROW(balanced(system, 1.0, ratio), std::invalid_argument) << ratio;
}

}  // namespace
}  // namespace beamid::balanced_truncation_test
