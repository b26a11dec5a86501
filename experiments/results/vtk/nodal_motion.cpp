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

}  // namespace

Eigen::Matrix3Xd nodal_places(const fem::StructuralSystem& system) {
  if (system.mesh.nodes.empty())
    throw std::invalid_argument("the system has no mesh; expected one of fem::assemble, not a reduced one");
  Eigen::Matrix3Xd places(3, static_cast<Eigen::Index>(system.mesh.nodes.size()));
  for (Eigen::Index i = 0; i < places.cols(); ++i)
    places.col(i) << system.mesh.nodes[i].x, 0.0, system.mesh.nodes[i].y;
  return places;
}

NodalMotion nodal_motion(const fem::StructuralSystem& system, const Eigen::VectorXd& q) {
  const auto nodes = static_cast<Eigen::Index>(system.mesh.nodes.size());
  NodalMotion motion{Eigen::Matrix3Xd::Zero(3, nodes), Eigen::Matrix3Xd::Zero(3, nodes)};
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
  double size = turned[node] * (motion.rotation(1, node) > 0.0 ? -1.0 : 1.0);
  if (moves) {
    const double u = motion.translation(0, node), w = motion.translation(2, node);
    size = u == 0.0 ? w : std::copysign(moved[node], std::abs(u) > std::abs(w) ? u : w);
  }
  if (size != 0.0) motion = {motion.translation / size, motion.rotation / size};
  return motion;
}

}  // namespace beamid::experiments
