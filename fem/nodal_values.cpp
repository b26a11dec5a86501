// Values at the nodes, of the coordinates of a kind.
#include <stdexcept>
#include <string>

#include "fem/assembly.hpp"

namespace beamid::fem {

Eigen::VectorXd nodal(const StructuralSystem& system, const Eigen::VectorXd& q, Coordinate::Kind kind) {
  if (q.size() != system.size())
    throw std::invalid_argument("motion has " + std::to_string(q.size()) + " entries; expected " +
                                std::to_string(system.size()));
  Eigen::VectorXd values = Eigen::VectorXd::Zero(system.nodes());
  for (Eigen::Index i = 0; i < system.size(); ++i)
    if (system.coordinates[i].kind == kind)
      values[system.coordinates[i].node] = q[i] / system.coordinates[i].scale;
  return values;
}

Eigen::VectorXd nodal_deflection(const StructuralSystem& system, const Eigen::VectorXd& q) {
  return nodal(system, q, Coordinate::Kind::deflection);
}

Eigen::VectorXd nodal_rotation(const StructuralSystem& system, const Eigen::VectorXd& q) {
  return nodal(system, q, Coordinate::Kind::rotation);
}

Eigen::VectorXd nodal_axial(const StructuralSystem& system, const Eigen::VectorXd& q) {
  return nodal(system, q, Coordinate::Kind::axial);
}

}  // namespace beamid::fem
