// Shapes from motions.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "reduction/reduction.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::pod_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using reduction::reduction_registry, reduction::Training;

reduction::Bases pod(const fem::StructuralSystem& system, const filters::Options& options,
                     const Training& training = {}) {
  return reduction_registry().make("pod", options)->bases(system, training);
}

// Histories of the nodes' deflections in some modes of the beam.
Training motion(const fem::StructuralSystem& system, const std::vector<double>& amplitudes) {
  const fem::Modes modes = fem::modes(system, static_cast<Index>(amplitudes.size()));
  Training training{system.mesh.positions(), MatrixXd::Zero(system.mesh.positions().size(), 50)};
  for (Index i = 0; i < modes.size(); ++i)
    for (Index k = 0; k < 50; ++k)
      training.deflections.col(k) += amplitudes[i] * std::cos(0.37 * static_cast<double>((i + 1) * k)) *
                                     nodal_deflection(system, modes.shape.col(i));
  return training;
}

TEST(ProperOrthogonalDecomposition, OfAMotionInOneModeIsThisMode) {
  // Oracle: the mode. Between the nodes least strain energy and the mode differ by the mesh's own error.
  const auto system = assemble(test::steel_beam(0.36049), 40);
  const auto bases = pod(system, {}, motion(system, {0.003}));
  const fem::Modes mode = fem::modes(system, 1);
  const double along = mode.shape.col(0).dot(system.mass * bases.shapes.col(0));
  EXPECT_NEAR(std::abs(along), 1.0, 1e-9);
  EXPECT_LT(bases.significance[1], 1e-9);
}

TEST(ProperOrthogonalDecomposition, SingularValuesAreTheShareOfEachMode) {
  // Oracle: modes are orthogonal (M) and cosines of these rates nearly so over the record; hence values close
  // to the ratio of amplitudes.
  const auto system = assemble(test::steel_beam(0.36049), 40);
  const auto bases = pod(system, {{"modes", 2.0}}, motion(system, {1.0, 0.1}));
  EXPECT_EQ(bases.significance[0], 1.0);
  EXPECT_NEAR(bases.significance[1], 0.1, 0.005);
  EXPECT_LT(bases.significance[2], 1e-6);
}

TEST(ProperOrthogonalDecomposition, OfAReleaseIsNearlyTheFirstMode) {
  // Oracle: exact amplitudes after a release from the static shape: 1.2 % of mode 2 at the tip of S(11.8).
  const auto system = assemble(test::steel_beam(0.36049), 20);
  const auto bases = pod(system, {});
  const fem::Modes modes = fem::modes(system, 1);
  EXPECT_NEAR(std::abs(modes.shape.col(0).dot(system.mass * bases.shapes.col(0))), 1.0, 1e-3);
  EXPECT_LT(bases.significance[1], 0.05);
  const auto model = reduction::project(system, bases);
  EXPECT_NEAR(fem::modes(model.system, 1).angular_frequency[0] / modes.angular_frequency[0], 1.0, 1e-3);
}

TEST(ProperOrthogonalDecomposition, OfEnoughMotionIsNoReduction) {
  // Oracle: all frequencies of a small system.
  const auto system = assemble(test::steel_beam(0.36049), 3);
  for (const char* response : {"release", "pulse", "base_pulse"}) {
    const auto model =
        reduction::project(system, pod(system, {{"modes", 6.0}, {"response", std::string(response)}}));
    const VectorXd full = fem::modes(system, 6).angular_frequency,
                   same = fem::modes(model.system, 6).angular_frequency;
    EXPECT_LT((full - same).cwiseQuotient(full).norm(), 1e-7) << response;
  }
}

TEST(ProperOrthogonalDecomposition, ShapesAreOrthonormal) {
  const auto system = assemble(test::steel_beam(0.36049), 30);
  const MatrixXd shapes = pod(system, {{"modes", 4.0}}).shapes;
  EXPECT_LT((shapes.transpose() * (system.mass * shapes) - MatrixXd::Identity(4, 4)).norm(), 1e-12);
}

TEST(ProperOrthogonalDecomposition, LearnsFromAFreeBeamAndFromOneOnAStop) {
  // Oracle: a pulse needs no supports; a cubic spring needs an integration, and its system stays reducible.
  fem::Beam beam = test::steel_beam(0.0);
  beam.supports.clear();
  const auto loose = assemble(beam, 10);
  EXPECT_THROW(pod(loose, {}), std::invalid_argument);
  const auto model =
      reduction::project(loose, pod(loose, {{"modes", 3.0}, {"response", "pulse"}, {"periods", 1.0}}));
  EXPECT_TRUE(fem::modes(model.system, 3).angular_frequency.allFinite());

  fem::Beam stopped = test::steel_beam(0.0);
  stopped.springs = {{1.1, 0.0, 0.0, 1e6}};
  const auto nonlinear = assemble(stopped, 10);
  const auto reduced = reduction::project(nonlinear, pod(nonlinear, {{"modes", 2.0}}));
  EXPECT_EQ(reduced.system.nonlinear_forces.size(), 1u);
}

TEST(ProperOrthogonalDecomposition, RefusesMoreShapesThanTheMotionHas) {
  const auto system = assemble(test::steel_beam(0.36049), 10);
  const Training one{VectorXd{{1.1}}, MatrixXd::Ones(1, 5)};
  EXPECT_EQ(pod(system, {}, one).shapes.cols(), 1);
  EXPECT_THROW(pod(system, {{"modes", 2.0}}, one), std::invalid_argument);
  EXPECT_THROW(pod(system, {{"response", "earthquake"}}), std::invalid_argument);
  EXPECT_THROW(pod(system, {{"periods", 0.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::pod_test
