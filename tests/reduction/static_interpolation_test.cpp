// Shapes known at some points only.
#include "reduction/reduction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/assembly.hpp"
#include "fem/stiffness_solver.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::static_interpolation_test {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using reduction::static_interpolation, reduction::Training;

const std::string owner = "reduction 'pod'";

double tip_load_shape(double x) {
  return (3.0 * 1.1 * x * x - x * x * x) / (2.0 * 1.1 * 1.1 * 1.1);
}

Training sampled(const std::vector<double>& positions) {
  Training training{VectorXd(static_cast<Eigen::Index>(positions.size())), {}};
  training.deflections.resize(training.positions.size(), 1);
  for (Eigen::Index i = 0; i < training.positions.size(); ++i) {
    training.positions[i] = positions[i];
    training.deflections(i, 0) = tip_load_shape(positions[i]);
  }
  return training;
}

TEST(StaticInterpolation, FindsTheStaticShapeOfAForceFromPointsAnywhere) {
  // Oracle: (3 L x^2 - x^3) / 2 L^3, bent by a force at one of the points, is the motion of least energy
  // through all of them; 0.31 and 0.777 m are no nodes.
  for (const int elements : {8, 300}) {
    const auto system = assemble(test::steel_beam(0.36049), elements);
    const Training training = sampled({0.0, 0.31, 0.777, 1.1});
    const VectorXd shape = static_interpolation(system, training, owner) * training.deflections;
    EXPECT_LT((shape - static_shape(system)).cwiseAbs().maxCoeff(), 1e-9) << elements;
  }
}

TEST(StaticInterpolation, GoesThroughWhatIsGivenAndHoldsSupports) {
  const auto system = assemble(test::steel_beam(0.0), 10);
  Training training{VectorXd{{0.2, 0.55, 0.9}}, MatrixXd{{0.3}, {-0.2}, {1.0}}};
  const VectorXd shape = static_interpolation(system, training, owner) * training.deflections;
  const VectorXd w = nodal_deflection(system, shape);
  EXPECT_EQ(w[0], 0.0);
  EXPECT_EQ(nodal_rotation(system, shape)[0], 0.0);
  EXPECT_NEAR(w[5], -0.2, 1e-13);
}

TEST(StaticInterpolation, LeavesAFreeBeamStraightBetweenTwoPoints) {
  // Oracle: two points of a free beam are joined without strain.
  fem::Beam beam = test::steel_beam(0.0);
  beam.supports.clear();
  const auto system = assemble(beam, 10);
  const Training training{VectorXd{{0.25, 1.0}}, MatrixXd{{0.25}, {1.0}}};
  const VectorXd w =
      nodal_deflection(system, static_interpolation(system, training, owner) * training.deflections);
  EXPECT_LT((w - system.mesh.positions()).norm(), 1e-12);
  const Training one{VectorXd{{0.25}}, MatrixXd{{1.0}}};
  EXPECT_THROW(static_interpolation(system, one, owner), std::invalid_argument);
}

TEST(StaticInterpolation, RefusesWhatMakesNoSense) {
  const auto system = assemble(test::steel_beam(0.0), 2);
  const auto message = [&](const VectorXd& positions, const MatrixXd& deflections) -> std::string {
    try {
      static_interpolation(system, {positions, deflections}, owner);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  const auto said = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos && text.starts_with(owner);
  };
  EXPECT_PRED2(said, message({}, {}), "no deflections");
  EXPECT_PRED2(said, message(VectorXd{{0.5, 1.0}}, MatrixXd{{1.0}}), "2 positions and 1 deflections");
  EXPECT_PRED2(said, message(VectorXd{{1.2}}, MatrixXd{{1.0}}), "1.2 m is off the beam; expected 0 to 1.1");
  EXPECT_PRED2(said, message(VectorXd{{std::nan("")}}, MatrixXd{{1.0}}), "not finite");
  EXPECT_PRED2(said, message(VectorXd{{0.5, 0.5}}, MatrixXd{{1.0}, {1.0}}), "given twice");
  EXPECT_PRED2(said, message(VectorXd{{0.0, 0.5}}, MatrixXd{{0.5}, {1.0}}), "a support holds it");
  EXPECT_PRED2(said, message(VectorXd{{0.5}}, MatrixXd{{0.0}}), "zero");
  EXPECT_PRED2(said, message(VectorXd{{0.0}}, MatrixXd{{1e-9}}), "a support holds it");
  const VectorXd many = VectorXd::LinSpaced(9, 0.1, 1.1);
  EXPECT_PRED2(said, message(many, many), "cannot follow so many points");
}

}  // namespace
}  // namespace beamid::static_interpolation_test
