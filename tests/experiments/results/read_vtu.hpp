// What VTK's own reader finds in a file.
#pragma once

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <Eigen/Dense>
#include <filesystem>
#include <string>

namespace beamid::experiments {

inline vtkSmartPointer<vtkUnstructuredGrid> read_vtu(const std::filesystem::path& file) {
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  return reader->GetOutput();
}

/// (components x tuples); empty when there is no such array.
inline Eigen::MatrixXd values_of(vtkDataArray* array) {
  if (array == nullptr) return {};
  Eigen::MatrixXd values(array->GetNumberOfComponents(), array->GetNumberOfTuples());
  for (Eigen::Index j = 0; j < values.cols(); ++j)
    for (int i = 0; i < values.rows(); ++i) values(i, j) = array->GetComponent(j, i);
  return values;
}

inline Eigen::MatrixXd point_array(vtkUnstructuredGrid* grid, const std::string& name) {
  return values_of(grid->GetPointData()->GetArray(name.c_str()));
}

inline Eigen::RowVectorXd cell_array(vtkUnstructuredGrid* grid, const std::string& name) {
  return values_of(grid->GetCellData()->GetArray(name.c_str()));
}

inline Eigen::Matrix3Xd points_of(vtkUnstructuredGrid* grid) {
  Eigen::Matrix3Xd points(3, grid->GetNumberOfPoints());
  for (Eigen::Index i = 0; i < points.cols(); ++i) grid->GetPoint(i, points.col(i).data());
  return points;
}

/// Volume that the cells of one Section enclose, 0 being the bodies, their points moved by `warp` (3 x
/// points), from the divergence theorem, 1/6 sum a . (b x c) over triangles; positive when all normals point
/// outwards.
inline double enclosed_volume(vtkUnstructuredGrid* grid, int section, const Eigen::Matrix3Xd& warp) {
  const Eigen::Matrix3Xd points = points_of(grid) + warp;
  const Eigen::RowVectorXd sections = cell_array(grid, "Section");
  double sum = 0.0;
  for (vtkIdType i = 0; i < grid->GetNumberOfCells(); ++i) {
    if (sections[i] != section) continue;
    vtkCell* const cell = grid->GetCell(i);
    for (int k = 1; k + 1 < cell->GetNumberOfPoints(); ++k) {
      const Eigen::Vector3d a = points.col(cell->GetPointId(0)), b = points.col(cell->GetPointId(k)),
                            c = points.col(cell->GetPointId(k + 1));
      sum += a.dot(b.cross(c)) / 6.0;
    }
  }
  return sum;
}

}  // namespace beamid::experiments
