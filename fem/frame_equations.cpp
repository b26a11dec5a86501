#include "fem/frame_equations.hpp"

namespace beamid::fem {

using Eigen::Index;

void FrameEquations::add_mass(int row, int column, double value, int direction) {
  if (row < 0 || value == 0.0) return;
  if (column >= 0) mass_.emplace_back(row, column, value);
  if (direction >= 0) base_.emplace_back(row, direction, -value);
}

void FrameEquations::add_damping(int coordinate, double value) {
  if (coordinate >= 0 && value != 0.0) damping_.emplace_back(coordinate, coordinate, value);
}

void FrameEquations::add_strain(int strain, int coordinate, double value) {
  if (coordinate >= 0 && value != 0.0) strain_.emplace_back(strain, coordinate, value);
}

void FrameEquations::add_rigidity(const Eigen::MatrixXd& rigidity, const Eigen::MatrixXd& flexibility) {
  const auto count = static_cast<int>(rigidity.rows());
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      if (rigidity(i, j) != 0.0) rigidity_.emplace_back(strains_ + i, strains_ + j, rigidity(i, j));
      if (flexibility(i, j) != 0.0) flexibility_.emplace_back(strains_ + i, strains_ + j, flexibility(i, j));
    }
  strains_ += count;
}

void FrameEquations::add_ground_spring(int coordinate, double rigidity) {
  if (coordinate < 0 || rigidity == 0.0) return;
  add_strain(strains_, coordinate, 1.0);
  rigidity_.emplace_back(strains_, strains_, rigidity);
  flexibility_.emplace_back(strains_, strains_, 1.0 / rigidity);
  ++strains_;
}

void FrameEquations::add_point(const std::string& name, const std::vector<int>& coordinates) {
  bool moves = false;
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
    if (coordinates[axis] < 0) continue;
    const auto place = static_cast<int>(output_names_.size());
    inputs_.emplace_back(coordinates[axis], place, 1.0);
    outputs_.emplace_back(place, coordinates[axis], 1.0);
    input_names_.push_back(name + "_force_" + axes_[axis]);
    output_names_.push_back(name + "_displacement_" + axes_[axis]);
    moves = true;
  }
  if (!moves)
    throw std::invalid_argument("point '" + name + "' is held by a support; expected one that can move");
}

void FrameEquations::put_into(StructuralSystem& system) const {
  const auto n = static_cast<Index>(system.coordinates.size());
  const auto points = static_cast<int>(output_names_.size());
  Triplets inputs = inputs_;
  for (const auto& entry : base_) inputs.emplace_back(entry.row(), points + entry.col(), entry.value());
  system.mass = sparse(n, n, mass_);
  system.damping = sparse(n, n, damping_);
  system.stiffness = {sparse(strains_, n, strain_), sparse(strains_, strains_, rigidity_),
                      sparse(strains_, strains_, flexibility_)};
  system.inputs = sparse(n, points + static_cast<Index>(axes_.size()), inputs);
  system.outputs = sparse(points, n, outputs_);
  system.input_names = input_names_;
  for (const char axis : axes_) system.input_names.push_back(std::string("base_acceleration_") + axis);
  system.output_names = output_names_;
}

}  // namespace beamid::fem
