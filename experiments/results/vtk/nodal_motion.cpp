#include "experiments/results/vtk/nodal_motion.hpp"

#include <cmath>
#include <stdexcept>

#include "fem/assembly.hpp"

namespace beamid::experiments {
namespace {

// First column whose length is the largest, to rounding, so that a symmetric shape has the same sign
// everywhere.
Eigen::Index first_largest(const Eigen::VectorXd& lengths) {
  const double largest = lengths.maxCoeff() * (1.0 - 1e-9);
  Eigen::Index i = 0;
  while (lengths[i] < largest) ++i;
  return i;
}

// Of components as large as one another the last.
double largest_component(const Eigen::Vector3d& vector) {
  double largest = 0.0;
  for (const double component : vector)
    if (std::abs(component) >= std::abs(largest)) largest = component;
  return largest;
}

}  // namespace

Eigen::Matrix3Xd nodal_places(const fem::StructuralSystem& system) {
  if (system.mesh.nodes.empty())
    throw std::invalid_argument("the system has no mesh; expected one of fem::assemble, not a reduced one");
  Eigen::Matrix3Xd places(3, static_cast<Eigen::Index>(system.mesh.nodes.size()));
  for (Eigen::Index i = 0; i < places.cols(); ++i)
    if (const fem::Mesh::Node& node = system.mesh.nodes[i]; system.mesh.spatial)
      places.col(i) << node.x, node.y, node.z;
    else
      places.col(i) << node.x, 0.0, node.y;
  return places;
}

NodalMotion nodal_motion(const fem::StructuralSystem& system, const Eigen::VectorXd& q) {
  const auto nodes = static_cast<Eigen::Index>(system.mesh.nodes.size());
  NodalMotion motion{Eigen::Matrix3Xd::Zero(3, nodes), Eigen::Matrix3Xd::Zero(3, nodes)};
  if (system.mesh.spatial) {
    using Kind = fem::Coordinate::Kind;
    Eigen::Index row = 0;
    for (const Kind kind : {Kind::axial, Kind::deflection, Kind::lateral})
      motion.translation.row(row++) = fem::nodal(system, q, kind).transpose();
    row = 0;
    for (const Kind kind : {Kind::rotation_x, Kind::rotation_y, Kind::rotation})
      motion.rotation.row(row++) = fem::nodal(system, q, kind).transpose();
    return motion;
  }
  motion.translation.row(0) = fem::nodal_axial(system, q).transpose();
  motion.translation.row(2) = fem::nodal_deflection(system, q).transpose();
  motion.rotation.row(1).noalias() -= fem::nodal_rotation(system, q).transpose();
  return motion;
}

NodalMotion scaled_mode(const fem::StructuralSystem& system, const Eigen::VectorXd& q) {
  NodalMotion motion = nodal_motion(system, q);
  const Eigen::VectorXd moved = motion.translation.colwise().norm(),
                        turned = motion.rotation.colwise().norm();
  const bool moves = moved.maxCoeff() > 0.0;
  const Eigen::Index node = first_largest(moves ? moved : turned);
  const double sense = largest_component(moves ? motion.translation.col(node) : motion.rotation.col(node));
  const bool against = !moves && !system.mesh.spatial;  // theta is - rotation_y
  const double size = std::copysign(moves ? moved[node] : turned[node], against ? -sense : sense);
  if (size != 0.0) motion = {motion.translation / size, motion.rotation / size};
  return motion;
}

}  // namespace beamid::experiments
