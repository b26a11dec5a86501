// Moments are matched.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "fem/response/frequency_response.hpp"
#include "fem/stiffness_solver.hpp"
#include "reduction/reduction.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::krylov_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using reduction::reduction_registry;

reduction::ReducedModel krylov(const fem::StructuralSystem& system, const filters::Options& options) {
  return reduce(system, *reduction_registry().make("krylov", options));
}

// Coefficients H r_j of the receptance's power series in s about zero, from dense matrices.
std::vector<MatrixXd> moments(const fem::StructuralSystem& system, int count) {
  const fem::StiffnessSolver solver(system.stiffness);
  const MatrixXd mass = system.mass, damping = system.damping;
  MatrixXd before = MatrixXd::Zero(system.size(), system.inputs.cols()),
           now = solver.solve(MatrixXd(system.inputs));
  std::vector<MatrixXd> result;
  for (int j = 0; j < count; ++j) {
    result.push_back(system.outputs * now);
    const MatrixXd next = -solver.solve(damping * now + mass * before);
    before = now;
    now = next;
  }
  return result;
}

TEST(Krylov, MatchesTwoMomentsPerVectorWhereTheForceActs) {
  // Oracle: H (K^-1 M)^j K^-1 E of the full system: without damping every second coefficient in s; 3 vectors
  // match the first 6 of those, and not the seventh.
  const auto system = assemble(test::steel_beam(0.36049), 20);
  const auto full = moments(system, 13), reduced = moments(krylov(system, {{"moments", 3.0}}).system, 13);
  for (int j = 0; j < 12; j += 2) EXPECT_NEAR(reduced[j](0, 0) / full[j](0, 0), 1.0, 1e-9) << j;
  EXPECT_GT(std::abs(reduced[12](0, 0) / full[12](0, 0) - 1.0), 1e-14);
}

TEST(Krylov, MatchesOneMomentPerVectorEverywhere) {
  // Oracle: as before, between points of which only the last takes part in the expansion.
  auto system = assemble(test::steel_beam(0.36049), 20, {{"a", 0.33}, {"tip", 1.1}});
  system.inputs = MatrixXd(MatrixXd(system.inputs).col(1)).sparseView();
  system.input_names = {"tip_force"};
  const auto full = moments(system, 6), reduced = moments(krylov(system, {{"moments", 3.0}}).system, 6);
  for (int j = 0; j < 6; j += 2) EXPECT_NEAR(reduced[j](0, 0) / full[j](0, 0), 1.0, 1e-9) << j;
}

TEST(Krylov, MatchesMomentsOfADampedBeam) {
  // Oracle: the power series of the full system with two dashpots; 4 vectors, 8 coefficients.
  fem::Beam beam = test::steel_beam(0.36049);
  beam.dashpots = {{0.44, 3.0, 0.0, 0.0}, {0.88, 0.0, 0.2, 0.0}};
  const auto system = assemble(beam, 20);
  const auto model = krylov(system, {{"moments", 4.0}});
  EXPECT_EQ(model.system.size(), 4);
  const auto full = moments(system, 8), reduced = moments(model.system, 8);
  for (int j = 0; j < 8; ++j) EXPECT_NEAR(reduced[j](0, 0) / full[j](0, 0), 1.0, 1e-8) << j;
}

TEST(Krylov, ItsFirstVectorIsTheStaticShape) {
  const auto system = assemble(test::steel_beam(0.36049), 20);
  const auto model = krylov(system, {{"moments", 1.0}});
  const VectorXd shape = model.shapes.col(0) / (system.outputs * model.shapes)(0, 0);
  EXPECT_LT((shape - static_shape(system)).norm(), 1e-12);
}

TEST(Krylov, MatchesTheReceptanceAtAnotherFrequency) {
  // Oracle: the direct receptance of the full system; beside the frequency the error grows as its fourth
  // power when two vectors (value and slope, and both twice by symmetry) are kept there.
  fem::Beam beam = test::steel_beam(0.36049);
  beam.dashpots = {{0.88, 3.0, 0.0, 0.0}};
  for (const bool damped : {false, true}) {
    if (!damped) beam.dashpots.clear();
    const auto system = assemble(beam, 40);
    const auto model = krylov(system, {{"moments", 1.0}, {"frequency_hz", 45.0}, {"frequency_moments", 2.0}});
    EXPECT_LE(model.system.size(), damped ? 5 : 3);
    const VectorXd at{{45.0, 45.5, 46.0}};
    const Eigen::VectorXcd full = receptance(system, {}, at, 0, 0),
                           reduced = receptance(model.system, {}, at, 0, 0);
    EXPECT_LT(std::abs(reduced[0] / full[0] - 1.0), 1e-8) << damped;
    const double near = std::abs(reduced[1] - full[1]), far = std::abs(reduced[2] - full[2]);
    EXPECT_LT(near, 1e-3 * std::abs(full[1]));
    EXPECT_GT(far / near, 8.0);
  }
}

TEST(Krylov, ManyVectorsStayIndependent) {
  // Oracle: 30 vectors hold the lowest 8 modes to rounding, as Lanczos' method does.
  const auto system = assemble(test::steel_beam(0.36049), 200);
  const auto model = krylov(system, {{"moments", 30.0}});
  ASSERT_EQ(model.system.size(), 30);
  EXPECT_LT((MatrixXd(model.system.mass) - MatrixXd::Identity(30, 30)).norm(), 1e-12);
  const VectorXd full = fem::modes(system, 8).angular_frequency,
                 reduced = fem::modes(model.system, 8).angular_frequency;
  EXPECT_LT((reduced - full).cwiseQuotient(full).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Krylov, TakesTheBaseIfAsked) {
  // Oracle: static deflection under an acceleration of the base.
  const auto system = assemble(test::steel_beam(0.36049), 20);
  const auto model = krylov(system, {{"moments", 1.0}, {"base", true}});
  EXPECT_EQ(model.system.size(), 2);
  EXPECT_NEAR(static_stiffness(model.system, 1, 0) / static_stiffness(system, 1, 0), 1.0, 1e-10);
}

TEST(Krylov, RefusesWhatItCannotExpandAbout) {
  const auto make = [](const filters::Options& options) { reduction_registry().make("krylov", options); };
  EXPECT_THROW(make({{"moments", 0.0}}), std::invalid_argument);
  EXPECT_THROW(make({{"frequency_hz", -3.0}}), std::invalid_argument);
  EXPECT_THROW(make({{"frequency_hz", std::nan("")}}), std::invalid_argument);
  auto system = assemble(test::steel_beam(0.0), 4);
  system.inputs.resize(system.size(), 0);
  system.input_names.clear();
  EXPECT_THROW(krylov(system, {}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::krylov_test
