#include "experiments/output/mode_shapes.hpp"

#include <vtkCell.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <gtest/gtest.h>

#include "fem/assembly.hpp"
#include "fem/cantilever.hpp"
#include "tests/experiments/output/temporary_folder.hpp"

namespace beamid::experiments {
namespace {

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

  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName((folder.path / "modes.vtu").c_str());
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  ASSERT_EQ(grid->GetNumberOfPoints(), elements + 1);
  ASSERT_EQ(grid->GetNumberOfCells(), elements);
  EXPECT_EQ(grid->GetCellType(0), VTK_LINE);
  const Eigen::VectorXd position = system.mesh.positions();
  const char* names[] = {"Mode 1 (4.1455 Hz)", "Mode 2 (26.1000 Hz)"};
  for (int mode = 0; mode < 2; ++mode) {
    vtkDataArray* array = grid->GetPointData()->GetArray(names[mode]);
    ASSERT_NE(array, nullptr) << names[mode];
    ASSERT_EQ(array->GetNumberOfComponents(), 3);
    const Eigen::VectorXd deflection = fem::nodal_deflection(system, modes.col(mode));
    for (Eigen::Index node = 0; node <= elements; ++node) {
      EXPECT_EQ(grid->GetPoint(node)[0], position[node]);
      EXPECT_EQ(array->GetComponent(node, 0), 0.0);
      EXPECT_EQ(array->GetComponent(node, 2), deflection[node] / deflection[elements]);
    }
  }
}

TEST(ModeShapes, SeriesHasTheFrequencyAsTime) {
  TemporaryFolder folder;
  const fem::StructuralSystem system = beam();
  write_mode_shapes(folder.path, system, shapes(system), Eigen::Vector2d(4.14551, 26.1));
  const std::string series = contents(folder.path / "modes.pvd");
  EXPECT_NE(series.find(R"(timestep="4.14551" part="0" file="mode_1.vtu")"), std::string::npos) << series;
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName((folder.path / "mode_2.vtu").c_str());
  reader->Update();
  vtkDataArray* array = reader->GetOutput()->GetPointData()->GetArray("Mode");
  ASSERT_NE(array, nullptr);
  EXPECT_EQ(array->GetComponent(elements, 2), 1.0);
}

TEST(ModeShapes, RefuseOtherSizes) {
  TemporaryFolder folder;
  const fem::StructuralSystem system = beam();
  EXPECT_THROW(write_mode_shapes(folder.path, system, shapes(system), Eigen::Vector3d(1, 2, 3)),
               std::invalid_argument);
  EXPECT_EQ(folder.entries(), 0u);
}

}  // namespace
}  // namespace beamid::experiments
