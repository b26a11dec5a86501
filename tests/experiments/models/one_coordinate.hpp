// What a reduction to one coordinate leaves.
#pragma once

#include "fem/structural_system.hpp"

namespace beamid::test {

/// M q'' + K q = f, y = reading q.
inline fem::StructuralSystem one_coordinate(double mass, double stiffness, double reading = 1.0) {
  const auto scalar = [](double value) {
    fem::SparseMatrix matrix(1, 1);
    matrix.insert(0, 0) = value;
    return matrix;
  };
  fem::StructuralSystem system;
  system.coordinates.resize(1);
  system.mass = scalar(mass);
  system.damping = scalar(0.0);
  system.stiffness = {scalar(1.0), scalar(stiffness), scalar(1.0 / stiffness)};
  system.inputs = scalar(1.0);
  system.outputs = scalar(reading);
  return system;
}

}  // namespace beamid::test
