#include "experiments/results/vtk/mode_shapes.hpp"

#include <numbers>
#include <regex>

#include <gtest/gtest.h>

#include "fem/assembly.hpp"
#include "fem/beam.hpp"
#include "fem/frame.hpp"
#include "tests/experiments/results/read_vtu.hpp"
#include "tests/experiments/results/temporary_folder.hpp"

namespace beamid::experiments::mode_shapes_test {
namespace {

using fem::Outline, fem::Variation;

constexpr int elements = 8;

fem::StructuralSystem beam() {
  return fem::assemble(fem::Cantilever{1.1, 228.96, 2.777, 0.36, 0.0}, elements);
}

// Any shapes do; the second is largest at the tip, downwards.
Eigen::MatrixXd shapes(const fem::StructuralSystem& system) {
  Eigen::MatrixXd shapes(system.size(), 2);
  for (Eigen::Index i = 0; i < system.size(); ++i) {
    const double x = static_cast<double>(i / 2 + 1) / elements;
    shapes.row(i) << 3 * x * x, -x * x * x;
  }
  return shapes;
}

// Oracle: VTK's own reader gives back every double that was written.
TEST(ModeShapes, ReadBackAsTheyWere) {
  TemporaryFolder folder;
  const fem::StructuralSystem system = beam();
  const Eigen::MatrixXd modes = shapes(system);
  write_mode_shapes(folder.path, system, modes, Eigen::Vector2d(4.14551, 26.1));
  EXPECT_EQ(folder.entries(), mode_shape_files(2).size());

  const auto grid = read_vtu(folder.path / "modes.vtu");
  ASSERT_EQ(grid->GetNumberOfPoints(), elements + 1);
  ASSERT_EQ(grid->GetNumberOfCells(), elements);
  EXPECT_EQ(grid->GetCellType(0), VTK_LINE);
  EXPECT_EQ(points_of(grid).row(0).transpose(), system.mesh.positions());
  const std::string names[] = {"Mode 1 (4.1455 Hz)", "Mode 2 (26.1000 Hz)"};
  for (int mode = 0; mode < 2; ++mode) {
    vtkDataArray* array = grid->GetPointData()->GetArray(names[mode].c_str());
    ASSERT_NE(array, nullptr) << names[mode];
    ASSERT_EQ(array->GetNumberOfComponents(), 3);
    EXPECT_EQ(array->GetDataType(), VTK_DOUBLE);
    const Eigen::VectorXd deflection = fem::nodal_deflection(system, modes.col(mode));
    const Eigen::VectorXd rotation = fem::nodal_rotation(system, modes.col(mode));
    const Eigen::MatrixXd turns = point_array(grid, names[mode] + " rotation");
    ASSERT_EQ(turns.rows(), 3);
    for (Eigen::Index node = 0; node <= elements; ++node) {
      EXPECT_EQ(array->GetComponent(node, 0), 0.0);
      EXPECT_EQ(array->GetComponent(node, 2), deflection[node] / deflection[elements]);
      EXPECT_EQ(turns(1, node), -rotation[node] / deflection[elements]);
    }
  }
}

TEST(ModeShapes, SeriesHasTheFrequencyAsTime) {
  TemporaryFolder folder;
  const fem::StructuralSystem system = beam();
  write_mode_shapes(folder.path, system, shapes(system), Eigen::Vector2d(4.14551, 26.1));
  const std::string series = contents(folder.path / "modes.pvd");
  EXPECT_NE(series.find(R"(timestep="4.14551" part="0" file="mode_1.vtu")"), std::string::npos) << series;
  const auto grid = read_vtu(folder.path / "mode_2.vtu");
  ASSERT_EQ(point_array(grid, "Mode").cols(), elements + 1);
  EXPECT_EQ(point_array(grid, "Mode")(2, elements), 1.0);
  EXPECT_EQ(point_array(grid, "Rotation").cols(), elements + 1);
}

// Two rigid-body modes have the frequency 0; two steps of one time would be shown together.
TEST(ModeShapes, SeriesHasOneTimeForEachMode) {
  TemporaryFolder folder;
  const fem::StructuralSystem system = beam();
  Eigen::MatrixXd three(system.size(), 3);
  three << shapes(system), shapes(system).col(0);
  write_mode_shapes(folder.path, system, three, Eigen::Vector3d(0.0, 0.0, 20.0));
  const std::string series = contents(folder.path / "modes.pvd");
  const std::regex step("timestep=\"([^\"]*)\"");
  std::vector<double> times;
  for (std::sregex_iterator it(series.begin(), series.end(), step), end; it != end; ++it)
    times.push_back(std::stod((*it)[1]));
  EXPECT_EQ(times, (std::vector<double>{0.0, 2e-8, 20.0}));
}

TEST(ModeShapes, RefuseOtherSizes) {
  TemporaryFolder folder;
  const fem::StructuralSystem system = beam();
  EXPECT_THROW(write_mode_shapes(folder.path, system, shapes(system), Eigen::Vector3d(1, 2, 3)),
               std::invalid_argument);
  fem::StructuralSystem reduced = system;
  reduced.mesh = {};
  EXPECT_THROW(write_mode_shapes(folder.path, reduced, shapes(system), Eigen::Vector2d(1, 2)),
               std::invalid_argument);
  EXPECT_EQ(folder.entries(), 0u);
}

// A beam of 0.5 m of a tapered rectangle, damaged at its end, 0.3 m of a uniform ellipse and 0.4 m of a sharp
// cone, with a mass in the middle and another 30 mm beyond the tip.
fem::Beam three_segments() {
  fem::Beam beam;
  beam.segments = {
      {0.5, {400.0, 3.0, 0.0, {}, {}, {Outline::Shape::rectangle, Variation::linear(0.06, 0.04), {0.02}}}},
      {0.3, {300.0, 2.0, 0.0, {}, {}, {Outline::Shape::ellipse, {0.04}, {0.02}}}},
      {0.4,
       {200.0,
        1.0,
        0.0,
        {},
        {},
        {Outline::Shape::ellipse, Variation::linear(0.04, 0), Variation::linear(0.02, 0)}}}};
  beam.supports = {{0.0, true, true}};
  beam.bodies = {{0.6, 0.5, 0.0, 0.0}, {1.2, 0.25, 0.001, 0.03}};
  beam.damages = {{0.4, 0.5, 0.3}};
  return beam;
}

// w = x^2 at every node, so that a unit of it bends the beam to the curvature 2.
Eigen::VectorXd parabola(const fem::StructuralSystem& system) {
  Eigen::VectorXd q(system.size());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const fem::Coordinate& c = system.coordinates[i];
    q[i] = c.kind == fem::Coordinate::Kind::deflection ? c.position * c.position : 2 * c.position * c.scale;
  }
  return q;
}

// Oracle: the beam's own description.
TEST(ModeShapes, LinesTellSectionElementAndStiffness) {
  TemporaryFolder folder;
  const fem::Beam described = three_segments();
  const fem::StructuralSystem system = fem::assemble(described, 12);
  write_mode_shapes(folder.path, {described, system}, parabola(system), Eigen::VectorXd::Constant(1, 5.0));
  const auto grid = read_vtu(folder.path / "modes.vtu");
  const auto count = static_cast<Eigen::Index>(system.mesh.elements.size());
  ASSERT_EQ(grid->GetNumberOfCells(), count + 2);
  ASSERT_EQ(grid->GetNumberOfPoints(), count + 1 + 2);
  const auto section = cell_array(grid, "Section"), element = cell_array(grid, "Element"),
             stiffness = cell_array(grid, "BendingStiffness"), damage = cell_array(grid, "Damage"),
             mass = cell_array(grid, "Mass");
  for (Eigen::Index e = 0; e < count; ++e) {
    const double x = 0.5 * (points_of(grid)(0, e) + points_of(grid)(0, e + 1));
    const bool damaged = x > 0.4 && x < 0.5;
    EXPECT_EQ(section[e], x < 0.5 ? 1 : x < 0.8 ? 2 : 3);
    EXPECT_EQ(element[e], e + 1);
    EXPECT_DOUBLE_EQ(damage[e], damaged ? 0.3 : 0.0);
    EXPECT_DOUBLE_EQ(stiffness[e], x < 0.5 ? (damaged ? 280.0 : 400.0) : x < 0.8 ? 300.0 : 200.0);
    EXPECT_EQ(mass[e], 0.0);
  }
  EXPECT_EQ(grid->GetCellType(count + 1), VTK_VERTEX);
  EXPECT_EQ(section[count + 1], 0);
  EXPECT_EQ(mass.tail(2), Eigen::RowVector2d(0.5, 0.25));
  // The eccentric mass lies beyond the tip and moves w + e theta, the tip's w being 1.44 m and theta 2.4.
  EXPECT_NEAR(points_of(grid)(0, count + 2), 1.23, 1e-15);
  EXPECT_NEAR(point_array(grid, "Mode 1 (5.0000 Hz)")(2, count + 2), (1.44 + 0.03 * 2.4) / 1.44, 1e-14);
}

// Oracles: volumes of a frustum, of a prism over the ellipse's 24-sided polygon, a b/8 24 sin(2 pi/24), of a
// cone over it and of the steel cubes. All normals point outwards, or the volumes would be smaller or
// negative.
TEST(ModeShapes, SurfaceEnclosesTheSectionsAndTheBodies) {
  TemporaryFolder folder;
  const fem::Beam described = three_segments();
  const fem::StructuralSystem system = fem::assemble(described, 12);
  write_mode_shapes(folder.path, {described, system, true}, parabola(system),
                    Eigen::VectorXd::Constant(1, 5.0));
  const auto grid = read_vtu(folder.path / "mode_1.vtu");
  const Eigen::Matrix3Xd still = Eigen::Matrix3Xd::Zero(3, grid->GetNumberOfPoints());
  const double polygon = 0.04 * 0.02 * 3.0 * std::sin(std::numbers::pi / 12);
  EXPECT_NEAR(enclosed_volume(grid, 1, still), 0.5 * 0.02 * 0.05, 1e-17);
  EXPECT_NEAR(enclosed_volume(grid, 2, still), 0.3 * polygon, 1e-17);
  EXPECT_NEAR(enclosed_volume(grid, 3, still), 0.4 * polygon / 3, 1e-17);
  EXPECT_NEAR(enclosed_volume(grid, 0, still), 0.75 / 7850, 1e-17);

  const Eigen::Matrix3Xd points = points_of(grid);
  const double edge = std::cbrt(0.25 / 7850);
  EXPECT_EQ(points.row(0).minCoeff(), 0.0);
  EXPECT_NEAR(points.row(0).maxCoeff(), 1.2 + 0.03 + edge / 2, 1e-15);
  EXPECT_NEAR(points.row(1).minCoeff(), -0.03, 1e-15);
  EXPECT_EQ(cell_array(grid, "Mass").maxCoeff(), 0.5);
  EXPECT_EQ(cell_array(grid, "Element").maxCoeff(), static_cast<double>(system.mesh.elements.size()));
}

// Oracle: a section stays plane, (-z theta, 0, w), with w = x^2 / 1.44 and theta = 2 x / 1.44; bending keeps
// the volume but for the sections' stretch, of second order in theta.
TEST(ModeShapes, WarpedSurfaceTurnsItsSections) {
  TemporaryFolder folder;
  const fem::Beam described = three_segments();
  const fem::StructuralSystem system = fem::assemble(described, 24);
  write_mode_shapes(folder.path, {described, system, true}, parabola(system),
                    Eigen::VectorXd::Constant(1, 5.0));
  const auto grid = read_vtu(folder.path / "modes.vtu");
  const Eigen::Matrix3Xd points = points_of(grid), mode = point_array(grid, "Mode 1 (5.0000 Hz)");
  ASSERT_TRUE(mode.allFinite());
  const Eigen::Index of_beam = points.cols() - 16;  // cubes come last
  for (Eigen::Index i = 0; i < of_beam; ++i) {
    const double x = points(0, i), z = points(2, i);
    EXPECT_NEAR(mode(0, i), -z * 2 * x / 1.44, 1e-14);
    EXPECT_EQ(mode(1, i), 0.0);
    EXPECT_NEAR(mode(2, i), x * x / 1.44, 1e-14);
  }
  const double volume = enclosed_volume(grid, 1, 0.0 * mode), warped = enclosed_volume(grid, 1, 0.1 * mode);
  EXPECT_NEAR(warped / volume, 1.0, 0.1 * 0.1);
  EXPECT_NE(warped, volume);
}

TEST(ModeShapes, SurfaceWithoutAnOutlineIsARibbon) {
  TemporaryFolder folder;
  const fem::Beam described = fem::Cantilever{1.0, 100.0, 2.0, 0.0, 0.0};
  const fem::StructuralSystem system = fem::assemble(described, 4);
  write_mode_shapes(folder.path, {described, system, true}, parabola(system),
                    Eigen::VectorXd::Constant(1, 5.0));
  const auto grid = read_vtu(folder.path / "modes.vtu");
  EXPECT_EQ(grid->GetNumberOfCells(), 4 * 4 + 2);
  EXPECT_EQ(grid->GetNumberOfPoints(), 5 * 4);
  EXPECT_NEAR(enclosed_volume(grid, 1, Eigen::Matrix3Xd::Zero(3, 20)), 1.0 / 20 / 100, 1e-17);
}

// Oracle: the joints, y upwards, and the displacement along x of the mode's only moving coordinate.
TEST(ModeShapes, FrameLiesInThePlaneOfXAndZ) {
  TemporaryFolder folder;
  fem::Frame frame;
  frame.joints = {{0, 0}, {0, 3}, {4, 3}};
  const fem::Section section{100.0, 1.0, 0.0, {}, 1e6, {}};
  frame.members = {{0, 1, section}, {1, 2, section}};
  frame.supports = {{0}};
  const fem::StructuralSystem system = fem::assemble(frame, 2);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(system.size());
  for (Eigen::Index i = 0; i < q.size(); ++i)
    if (system.coordinates[i].node == 2 && system.coordinates[i].kind == fem::Coordinate::Kind::axial)
      q[i] = -0.5;
  write_mode_shapes(folder.path, system, q, Eigen::VectorXd::Constant(1, 5.0));
  const auto grid = read_vtu(folder.path / "mode_1.vtu");
  ASSERT_EQ(grid->GetNumberOfCells(), 4);
  EXPECT_EQ(points_of(grid).col(2), Eigen::Vector3d(4, 0, 3));
  EXPECT_EQ(point_array(grid, "Mode").col(2), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(cell_array(grid, "Section"), Eigen::RowVector4d(1, 1, 2, 2));
}

TEST(ModeShapes, HugeMeshIsThinnedButKeepsItsEnds) {
  TemporaryFolder folder;
  const fem::Beam described = three_segments();
  const fem::StructuralSystem system = fem::assemble(described, 21'000);
  write_mode_shapes(folder.path, {described, system, true}, parabola(system),
                    Eigen::VectorXd::Constant(1, 5.0));
  const auto grid = read_vtu(folder.path / "modes.vtu");
  EXPECT_LT(grid->GetNumberOfCells(), 24 * 20'000);
  const double polygon = 0.04 * 0.02 * 3.0 * std::sin(std::numbers::pi / 12);
  const Eigen::Matrix3Xd still = Eigen::Matrix3Xd::Zero(3, grid->GetNumberOfPoints());
  EXPECT_NEAR(enclosed_volume(grid, 3, still), 0.4 * polygon / 3, 1e-12 * polygon);
  EXPECT_NEAR(enclosed_volume(grid, 1, still), 0.5 * 0.02 * 0.05, 1e-14);
}

}  // namespace
}  // namespace beamid::experiments::mode_shapes_test
