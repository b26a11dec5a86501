// What VTK does for beamid, as a library of its own: it is loaded when a mesh is written (vtu_file.cpp), so
// that nothing else waits for VTK, or needs it installed.
#include "experiments/results/vtk/vtu_text.hpp"

#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

namespace beamid::experiments {
namespace {

int type_of(const BeamGrid::Cell& cell) {
  switch (cell.size) {
    case 1:
      return VTK_VERTEX;
    case 2:
      return VTK_LINE;
    case 4:
      return VTK_QUAD;
    default:
      return VTK_POLYGON;
  }
}

void set_mesh(vtkUnstructuredGrid* to, const BeamGrid& grid) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (std::size_t i = 0; i < grid.points.size(); ++i) points->InsertNextPoint(grid.place(i).data());
  to->SetPoints(points);
  std::vector<vtkIdType> corners;
  for (const BeamGrid::Cell& cell : grid.cells) {
    const auto first = grid.corners.begin() + static_cast<std::ptrdiff_t>(cell.first_corner);
    corners.assign(first, first + cell.size);
    to->InsertNextCell(type_of(cell), cell.size, corners.data());
  }
}

template <class Array, class Value>
void add_cell_data(vtkUnstructuredGrid* to, const BeamGrid& grid, const char* name,
                   Value BeamGrid::Cell::*value) {
  vtkNew<Array> array;
  array->SetName(name);
  for (const BeamGrid::Cell& cell : grid.cells) array->InsertNextValue(cell.*value);
  to->GetCellData()->AddArray(array);
}

void add_point_data(vtkUnstructuredGrid* to, const PointArray& values) {
  vtkNew<vtkDoubleArray> array;
  array->SetName(values.name.c_str());
  array->SetNumberOfComponents(3);
  for (const auto& vector : values.values.colwise()) array->InsertNextTuple3(vector[0], vector[1], vector[2]);
  to->GetPointData()->AddArray(array);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) bool beamid_vtu_text(const BeamGrid& grid,
                                                                       const std::vector<PointArray>& arrays,
                                                                       std::string& text) {
  vtkNew<vtkUnstructuredGrid> out;
  set_mesh(out, grid);
  for (const PointArray& array : arrays) add_point_data(out, array);
  add_cell_data<vtkIntArray>(out, grid, "Section", &BeamGrid::Cell::section);
  add_cell_data<vtkIntArray>(out, grid, "Element", &BeamGrid::Cell::element);
  add_cell_data<vtkDoubleArray>(out, grid, "BendingStiffness", &BeamGrid::Cell::bending_stiffness);
  add_cell_data<vtkDoubleArray>(out, grid, "Damage", &BeamGrid::Cell::damage);
  add_cell_data<vtkDoubleArray>(out, grid, "Mass", &BeamGrid::Cell::mass);
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(out);
  writer->SetDataModeToBinary();  // every digit
  writer->SetCompressorTypeToNone();
  writer->WriteToOutputStringOn();  // VTK does not notice a full disk, write_file does
  if (writer->Write() == 0) return false;
  text = writer->GetOutputString();
  return true;
}

extern "C" __attribute__((visibility("default"))) const char* const beamid_vtk_made_for = BEAMID_VERSION;

}  // namespace beamid::experiments
