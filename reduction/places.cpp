#include "reduction/places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace beamid::reduction {
namespace {

using Kind = fem::Coordinate::Kind;
using RowMajor = Eigen::SparseMatrix<double, Eigen::RowMajor>;

void require_mesh(const fem::StructuralSystem& system, const std::string& owner) {
  if (system.mesh.nodes.empty())
    throw std::invalid_argument(owner + " needs a mesh; this system is a reduced one");
}

bool is_frame(const fem::StructuralSystem& system) {
  return std::any_of(system.coordinates.begin(), system.coordinates.end(),
                     [](const fem::Coordinate& coordinate) { return coordinate.kind == Kind::axial; });
}

int nearest_node(const fem::StructuralSystem& system, double position, const std::string& owner) {
  const Eigen::VectorXd nodes = system.mesh.positions();
  const double first = nodes.minCoeff(), last = nodes.maxCoeff(), same = 1e-9 * (last - first);
  if (!(position >= first - same && position <= last + same)) {
    std::ostringstream message;
    message << owner << ": position " << position << " m is off the beam; expected " << first << " to "
            << last << " m";
    throw std::invalid_argument(message.str());
  }
  Eigen::Index nearest = 0;
  (nodes.array() - position).abs().minCoeff(&nearest);
  return static_cast<int>(nearest);
}

int deflection_at(const fem::StructuralSystem& system, double position, const std::string& owner) {
  const int node = nearest_node(system, position, owner);
  for (std::size_t i = 0; i < system.coordinates.size(); ++i)
    if (system.coordinates[i].node == node && system.coordinates[i].kind == Kind::deflection)
      return static_cast<int>(i);
  std::ostringstream message;
  message << owner << ": the node nearest to " << position << " m, at " << system.mesh.nodes[node].x
          << " m, is held by a support; expected one that can move";
  throw std::invalid_argument(message.str());
}

std::vector<int> observed_coordinates(const fem::StructuralSystem& system, const std::string& owner) {
  std::vector<int> observed;
  const RowMajor outputs = system.outputs;
  for (Eigen::Index row = 0; row < outputs.rows(); ++row) {
    int column = -1, entries = 0;
    for (RowMajor::InnerIterator it(outputs, row); it; ++it) {
      if (it.value() == 0.0) continue;
      column = static_cast<int>(it.col());
      ++entries;
    }
    if (entries != 1) continue;
    const Kind kind = system.coordinates[column].kind;
    if ((kind == Kind::deflection || kind == Kind::axial || kind == Kind::lateral) &&
        std::find(observed.begin(), observed.end(), column) == observed.end())
      observed.push_back(column);
  }
  if (observed.empty())
    throw std::invalid_argument(owner +
                                " finds no output that reads a deflection; expected one, or positions");
  return observed;
}

}  // namespace

std::vector<int> master_coordinates(const fem::StructuralSystem& system, const std::vector<double>& positions,
                                    const std::string& owner) {
  if (positions.empty()) return observed_coordinates(system, owner);
  require_mesh(system, owner);
  if (is_frame(system))
    throw std::invalid_argument(owner +
                                ": a position does not tell a joint of a frame; expected none, which means "
                                "where the outputs are");
  std::vector<int> masters;
  for (const double position : positions) {
    const int coordinate = deflection_at(system, position, owner);
    if (std::find(masters.begin(), masters.end(), coordinate) != masters.end()) {
      std::ostringstream message;
      message << owner << ": position " << position << " m is nearest to the node at "
              << system.coordinates[coordinate].position
              << " m, and so is one before; expected each near a node of its own";
      throw std::invalid_argument(message.str());
    }
    masters.push_back(coordinate);
  }
  return masters;
}

std::vector<int> interface_coordinates(const fem::StructuralSystem& system,
                                       const std::vector<double>& positions, const std::string& owner) {
  std::vector<int> held;
  for (const int master : master_coordinates(system, positions, owner))
    for (std::size_t i = 0; i < system.coordinates.size(); ++i)
      if (system.coordinates[i].node == system.coordinates[master].node &&
          std::find(held.begin(), held.end(), static_cast<int>(i)) == held.end())
        held.push_back(static_cast<int>(i));
  return held;
}

std::vector<int> force_inputs(const fem::StructuralSystem& system) {
  std::vector<int> forces;
  for (int i = 0; i < system.inputs.cols(); ++i)
    if (static_cast<std::size_t>(i) >= system.input_names.size() ||
        !system.input_names[i].starts_with("base_acceleration"))
      forces.push_back(i);
  return forces;
}

int base_input(const fem::StructuralSystem& system) {
  for (std::size_t i = 0; i < system.input_names.size(); ++i)
    if (system.input_names[i] == "base_acceleration" || system.input_names[i] == "base_acceleration_y")
      return static_cast<int>(i);
  return -1;
}

}  // namespace beamid::reduction
