#include "experiments/results/vtk/field_history.hpp"

#include <gtest/gtest.h>

#include "fem/assembly.hpp"
#include "fem/beam.hpp"
#include "fem/response/response.hpp"
#include "tests/experiments/results/read_vtu.hpp"
#include "tests/experiments/results/temporary_folder.hpp"

namespace beamid::experiments::field_history_test {
namespace {

const fem::Beam described = fem::Cantilever{1.1, 228.96, 2.777, 0.36, 0.0};

// Three of 1001 samples, with any fields.
fem::Response response_of(const fem::StructuralSystem& system) {
  fem::Response response;
  response.time = Eigen::VectorXd::LinSpaced(1001, 0.0, 1.0);
  response.frames = {0, 500, 1000};
  const auto field = [&](double seed) {
    Eigen::MatrixXd values(system.size(), 3);
    for (Eigen::Index i = 0; i < values.size(); ++i)
      values.data()[i] = std::sin(seed + 0.7 * static_cast<double>(i));
    return values;
  };
  response.field_displacement = field(1);
  response.field_velocity = field(2);
  response.field_acceleration = field(3);
  return response;
}

// Oracle: the fields themselves, every digit, at the nodes.
TEST(FieldHistory, ReadsBackAsItWas) {
  TemporaryFolder folder;
  const fem::StructuralSystem system = fem::assemble(described, 8);
  const fem::Response response = response_of(system);
  write_field_history(folder.path, system, response);
  EXPECT_EQ(folder.entries(), field_history_files(3).size());
  for (const std::string& file : field_history_files(3))
    EXPECT_TRUE(std::filesystem::exists(folder.path / file));
  const std::string series = contents(folder.path / "response.pvd");
  EXPECT_NE(series.find(R"(timestep="0" part="0" file="frame_0000.vtu")"), std::string::npos) << series;
  EXPECT_NE(series.find(R"(timestep="0.5" part="0" file="frame_0001.vtu")"), std::string::npos) << series;

  const auto grid = read_vtu(folder.path / "frame_0002.vtu");
  ASSERT_EQ(grid->GetNumberOfPoints(), 9);
  ASSERT_EQ(grid->GetNumberOfCells(), 8);
  const auto expect = [&](const char* name, const Eigen::MatrixXd& field) {
    const Eigen::MatrixXd values = point_array(grid, name);
    ASSERT_EQ(values.rows(), 3) << name;
    EXPECT_EQ(values.row(2).transpose(), fem::nodal_deflection(system, field.col(2))) << name;
    EXPECT_EQ(values.topRows(2).norm(), 0.0) << name;
  };
  expect("Displacement", response.field_displacement);
  expect("Velocity", response.field_velocity);
  expect("Acceleration", response.field_acceleration);
  EXPECT_EQ(point_array(grid, "Rotation").row(1).transpose(),
            -fem::nodal_rotation(system, response.field_displacement.col(2)));
}

// Oracle: rigid motion of the tip's section, u = -z theta, and of the tip mass's cube with it.
TEST(FieldHistory, SurfaceMovesWithItsSections) {
  TemporaryFolder folder;
  const fem::StructuralSystem system = fem::assemble(described, 8);
  const fem::Response response = response_of(system);
  write_field_history(folder.path, {described, system, true}, response);
  const auto grid = read_vtu(folder.path / "frame_0001.vtu");
  const Eigen::Matrix3Xd points = points_of(grid), velocity = point_array(grid, "Velocity");
  const double w = fem::nodal_deflection(system, response.field_velocity.col(1))[8],
               theta = fem::nodal_rotation(system, response.field_velocity.col(1))[8];
  int checked = 0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const bool cube = i >= points.cols() - 8;
    if (!cube && points(0, i) < 1.1) continue;
    EXPECT_NEAR(velocity(0, i), -points(2, i) * theta, 1e-14);
    EXPECT_NEAR(velocity(2, i), w + (points(0, i) - 1.1) * theta, 1e-14);
    ++checked;
  }
  EXPECT_EQ(checked, 4 + 8);
}

TEST(FieldHistory, RefusesWhatDoesNotFit) {
  TemporaryFolder folder;
  const fem::StructuralSystem system = fem::assemble(described, 8);
  fem::Response response = response_of(system);
  response.field_velocity.conservativeResize(3, 3);
  EXPECT_THROW(write_field_history(folder.path, system, response), std::invalid_argument);
  response = response_of(system);
  response.frames.back() = 1001;
  EXPECT_THROW(write_field_history(folder.path, system, response), std::invalid_argument);
  response = {};
  EXPECT_THROW(write_field_history(folder.path, system, response), std::invalid_argument);
  EXPECT_EQ(folder.entries(), 0u);
}

}  // namespace
}  // namespace beamid::experiments::field_history_test
