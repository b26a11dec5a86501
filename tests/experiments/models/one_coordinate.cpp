#include "tests/experiments/models/one_coordinate.hpp"

namespace beamid::test {

fem::StructuralSystem one_coordinate(double mass, double stiffness, double reading) {
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
