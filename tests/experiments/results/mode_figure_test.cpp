#include "experiments/results/mode_figure.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "fem/assembly.hpp"
#include "fem/frame.hpp"
#include "tests/experiments/results/temporary_folder.hpp"

namespace beamid::experiments::mode_figure_test {
namespace {

// Pinned at both ends, cut into few elements.
fem::StructuralSystem pinned(int elements) {
  fem::Beam beam;
  beam.segments = {{2.0, {100.0, 3.0, 0.0, {}, {}, {}}}};
  beam.supports = {{0.0, true, false}, {2.0, true, false}};
  return fem::assemble(beam, elements);
}

// sin(i pi x/L) with its slope at the nodes.
Eigen::MatrixXd sines(const fem::StructuralSystem& system, int count) {
  Eigen::MatrixXd shapes(system.size(), count);
  for (int mode = 0; mode < count; ++mode)
    for (Eigen::Index i = 0; i < system.size(); ++i) {
      const fem::Coordinate& c = system.coordinates[i];
      const double wave = (mode + 1) * std::numbers::pi / 2.0;
      shapes(i, mode) = c.kind == fem::Coordinate::Kind::deflection
                            ? std::sin(wave * c.position)
                            : wave * std::cos(wave * c.position) * c.scale;
    }
  return shapes;
}

// Oracle: the sine itself. Hermite's cubic misses it by (i pi h/L)^4/384 at most, a straight line by (i pi
// h/L)^2/8.
TEST(ModeFigure, CurvesAreSmoothBetweenFewNodes) {
  const fem::StructuralSystem system = pinned(6);
  const Figure figure = mode_figure(system, sines(system, 3), Eigen::Vector3d(4.1455, 26.0, 123.456));
  ASSERT_EQ(figure.panels.size(), 3u);
  EXPECT_EQ(figure.panels[0].title, "mode 1, 4.1455 Hz");
  EXPECT_EQ(figure.panels[2].title, "mode 3, 123.46 Hz");
  for (int mode = 1; mode <= 3; ++mode) {
    const Curve& curve = figure.panels[mode - 1].curves.back();
    EXPECT_GT(curve.x.size(), 300);
    EXPECT_NEAR(curve.y.cwiseAbs().maxCoeff(), 1.0, 1e-15);
    const double bound = 2.1 * std::pow(mode * std::numbers::pi / 6, 4) / 384;  // twice: scaled to 1 as well
    const double sign = curve.y[20] < 0 ? -1 : 1;
    for (Eigen::Index i = 0; i < curve.x.size(); ++i)
      EXPECT_NEAR(sign * curve.y[i], std::sin(mode * std::numbers::pi * curve.x[i] / 2.0), bound);
  }
}

// Oracle: the sine again, and the body's own place: a body that is rigidly fixed to the middle moves as the
// middle.
TEST(ModeModel, SwingsAsTheFigureIsDrawnAndCarriesBodies) {
  fem::Beam beam;
  beam.segments = {{2.0, {100.0, 3.0, 0.0, {}, {}, {}}}};
  beam.supports = {{0.0, true, false}, {2.0, true, false}};
  beam.bodies.emplace_back();
  beam.bodies.back().position = 1.0;
  beam.bodies.back().mass = 0.5;
  const fem::StructuralSystem system = fem::assemble(beam, 6);
  const SwingModel model = mode_model(Picture(beam, system), sines(system, 2), Eigen::Vector2d(4.1455, 26.0));
  ASSERT_EQ(model.modes.size(), 2u);
  EXPECT_EQ(model.modes[1].name, "mode 2, 26.000 Hz");
  const SwingModel::Part& axis = model.parts.back();
  EXPECT_EQ(axis.kind, SwingModel::Kind::lines);
  ASSERT_EQ(axis.motion.size(), 2u);
  for (Eigen::Index i = 0; i < axis.points.cols(); ++i) {
    EXPECT_NEAR(axis.motion[0](2, i), std::sin(std::numbers::pi * axis.points(0, i) / 2.0), 1e-3);
    EXPECT_EQ(axis.motion[0](1, i), 0);
  }
  const SwingModel::Part& solids = model.parts.front();
  EXPECT_EQ(solids.kind, SwingModel::Kind::triangles);
  double highest = 0;
  for (Eigen::Index i = 0; i < solids.points.cols(); ++i)
    if (std::abs(solids.points(0, i) - 1.0) < 0.1) highest = std::max(highest, solids.motion[0](2, i));
  EXPECT_NEAR(highest, 1.0, 1e-9);
  EXPECT_EQ(binary_gltf(model), binary_gltf(model));
}

// Oracle: the motion itself, 3 mm of the first sine and 1 mm of the second, each at its own frequency.
TEST(MotionModel, HoldsAMotionByItsOwnShapes) {
  const fem::StructuralSystem system = pinned(6);
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(200, 0, 2);
  Eigen::MatrixXd histories(2, time.size());
  histories << 0.003 * (9 * time.array()).cos().matrix().transpose(),
      0.001 * (36 * time.array()).sin().matrix().transpose();
  const auto [model, history] = motion_model(Picture(system), time, sines(system, 2) * histories);
  EXPECT_EQ(history.weights.rows(), 2);
  EXPECT_LT(history.residual_percent, 1e-4);
  const SwingModel::Part& axis = model.parts.back();
  double largest = 0;
  for (Eigen::Index sample = 0; sample < time.size(); ++sample) {
    const Eigen::Matrix3Xd moved =
        history.weights(0, sample) * axis.motion[0] + history.weights(1, sample) * axis.motion[1];
    for (Eigen::Index i = 0; i < axis.points.cols(); ++i) {
      const double place = std::numbers::pi * axis.points(0, i) / 2.0;
      EXPECT_NEAR(moved(2, i),
                  histories(0, sample) * std::sin(place) + histories(1, sample) * std::sin(2 * place), 2e-5);
    }
    largest = std::max(largest, moved.row(2).cwiseAbs().maxCoeff());
  }
  EXPECT_NEAR(history.largest, largest, 0.02 * largest);  // it is taken at the nodes
  EXPECT_THROW(motion_model(Picture(system), time, histories), std::invalid_argument);
}

TEST(ModeFigure, IsDrawnAsPngAndSvg) {
  TemporaryFolder folder;
  const fem::StructuralSystem system = pinned(20);
  const Figure figure = mode_figure(system, sines(system, 20), Eigen::VectorXd::LinSpaced(20, 0.0, 100.0));
  EXPECT_EQ(figure.panels.size(), 12u);
  EXPECT_EQ(figure.panels[0].title, "mode 1, rigid body");
  write(figure, folder.path);
  EXPECT_EQ(contents(folder.path / "mode_shapes.png").substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_NE(contents(folder.path / "mode_shapes.svg").find("mode 12, 57.895 Hz"), std::string::npos);
}

// Oracle: a leaning cantilever whose tip moves across it, drawn by an eighth of its extent, the larger of 3
// and 4 m.
TEST(ModeFigure, FrameIsDrawnInItsPlane) {
  fem::Frame frame;
  frame.joints = {{0, 0}, {3, 4}};
  frame.members = {{0, 1, {100.0, 1.0, 0.0, {}, 1e6, {}}}};
  frame.supports = {{0}};
  const fem::StructuralSystem system = fem::assemble(frame, 4);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(system.size());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    if (system.coordinates[i].node != 1) continue;
    if (system.coordinates[i].kind == fem::Coordinate::Kind::axial) q[i] = -0.8;
    if (system.coordinates[i].kind == fem::Coordinate::Kind::deflection) q[i] = 0.6;
  }
  const Figure figure = mode_figure(system, q, Eigen::VectorXd::Constant(1, 7.0));
  const Curve &still = figure.panels[0].curves[0], &moved = figure.panels[0].curves[1];
  EXPECT_EQ(still.x[still.x.size() - 1], 3.0);
  EXPECT_EQ(still.y[still.y.size() - 1], 4.0);
  // The sign is settled by the larger component, along x.
  EXPECT_NEAR(moved.x[moved.x.size() - 1], 3.0 + 0.8 * 0.5, 1e-12);
  EXPECT_NEAR(moved.y[moved.y.size() - 1], 4.0 - 0.6 * 0.5, 1e-12);
}

TEST(ModeFigure, RefusesOtherSizes) {
  const fem::StructuralSystem system = pinned(6);
  EXPECT_THROW(mode_figure(system, sines(system, 3), Eigen::Vector2d(1, 2)), std::invalid_argument);
  EXPECT_THROW(mode_figure(system, Eigen::MatrixXd(system.size(), 0), Eigen::VectorXd()),
               std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::mode_figure_test
