#include "experiments/models/oscillator.hpp"

#include <stdexcept>
#include <string>

namespace beamid::experiments {
namespace {

fem::SparseMatrix scalar(double value) {
  fem::SparseMatrix matrix(1, 1);
  matrix.insert(0, 0) = value;
  return matrix;
}

}  // namespace

fem::StructuralSystem one_coordinate(const Oscillator& oscillator) {
  if (!(oscillator.stiffness > 0.0))
    throw std::invalid_argument("stiffness: " + std::to_string(oscillator.stiffness) +
                                " N/m; expected a positive number");
  fem::StructuralSystem system;
  system.coordinates.resize(1);
  system.mass = scalar(oscillator.mass);
  system.damping = scalar(oscillator.damping);
  system.stiffness = {scalar(1.0), scalar(oscillator.stiffness), scalar(1.0 / oscillator.stiffness)};
  system.inputs = system.outputs = scalar(1.0);
  return system;
}

}  // namespace beamid::experiments
