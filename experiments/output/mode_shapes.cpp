#include "experiments/output/mode_shapes.hpp"

#include <fmt/format.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <stdexcept>

#include "experiments/output/file.hpp"
#include "fem/assembly.hpp"

namespace beamid::experiments {
namespace {

std::string series_file(Eigen::Index mode) {
  return fmt::format("mode_{}.vtu", mode + 1);
}

void set_mesh(vtkUnstructuredGrid* grid, const Eigen::VectorXd& position) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const double x : position) points->InsertNextPoint(x, 0.0, 0.0);
  grid->SetPoints(points);
  for (vtkIdType element = 0; element + 1 < position.size(); ++element) {
    const vtkIdType ends[] = {element, element + 1};
    grid->InsertNextCell(VTK_LINE, 2, ends);
  }
}

void add_mode(vtkUnstructuredGrid* grid, const std::string& name, const Eigen::VectorXd& deflection) {
  vtkNew<vtkDoubleArray> array;
  array->SetName(name.c_str());
  array->SetNumberOfComponents(3);
  for (const double w : deflection) array->InsertNextTuple3(0.0, 0.0, w);
  grid->GetPointData()->AddArray(array);
}

void write_grid(vtkUnstructuredGrid* grid, const std::filesystem::path& file) {
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(grid);
  writer->SetDataModeToBinary();  // every digit
  writer->SetCompressorTypeToNone();
  writer->WriteToOutputStringOn();  // VTK does not notice a full disk, write_file does
  if (writer->Write() == 0) throw std::runtime_error("VTK cannot write '" + file.string() + "'");
  write_file(file, writer->GetOutputString());
}

// The largest deflection becomes +1, which settles the sign as well.
Eigen::VectorXd scaled(const Eigen::VectorXd& deflection) {
  Eigen::Index largest = 0;
  if (deflection.cwiseAbs().maxCoeff(&largest) == 0.0) return deflection;
  return deflection / deflection[largest];
}

}  // namespace

std::vector<std::string> mode_shape_files(Eigen::Index modes) {
  std::vector<std::string> files{"modes.vtu", "modes.pvd"};
  for (Eigen::Index mode = 0; mode < modes; ++mode) files.push_back(series_file(mode));
  return files;
}

void write_mode_shapes(const std::filesystem::path& folder, const fem::StructuralSystem& system,
                       const Eigen::MatrixXd& shapes, const Eigen::VectorXd& frequencies_hz) {
  if (shapes.rows() != system.size() || shapes.cols() != frequencies_hz.size())
    throw std::invalid_argument(
        fmt::format("mode shapes are {} x {}; expected {} x {}, a column for each frequency", shapes.rows(),
                    shapes.cols(), system.size(), frequencies_hz.size()));
  const Eigen::VectorXd position = system.mesh.positions();
  vtkNew<vtkUnstructuredGrid> all;
  set_mesh(all, position);
  std::string series;
  for (Eigen::Index mode = 0; mode < shapes.cols(); ++mode) {
    const Eigen::VectorXd deflection = scaled(fem::nodal_deflection(system, shapes.col(mode)));
    add_mode(all, fmt::format("Mode {} ({:.4f} Hz)", mode + 1, frequencies_hz[mode]), deflection);
    vtkNew<vtkUnstructuredGrid> one;
    set_mesh(one, position);
    add_mode(one, "Mode", deflection);
    write_grid(one, folder / series_file(mode));
    series += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", frequencies_hz[mode],
                          series_file(mode));
  }
  write_grid(all, folder / "modes.vtu");
  write_file(
      folder / "modes.pvd",
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n" +
          series + "  </Collection>\n</VTKFile>\n");
}

}  // namespace beamid::experiments
