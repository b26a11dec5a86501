// Values at the nodes, and what a strain gauge reads from the rotations of those around it.
#include <cmath>
#include <stdexcept>
#include <string>

#include "fem/assembly.hpp"
#include "fem/parametric_system.hpp"

namespace beamid::fem {
namespace {

constexpr int most_nodes = 5;

// Derivative at t = 0 of the polynomial through values at t = 0, 1, .. k - 1: its weights.
std::vector<double> derivative_weights(int k) {
  std::vector<double> weights(static_cast<std::size_t>(k), 0.0);
  for (int j = 1; j < k; ++j) {  // L_j'(0) = (1/j) prod_{m != 0, j} m / (m - j)
    double weight = 1.0 / j;
    for (int m = 1; m < k; ++m)
      if (m != j) weight *= static_cast<double>(m) / (m - j);
    weights[static_cast<std::size_t>(j)] = weight;
    weights[0] -= weight;
  }
  return weights;
}

}  // namespace

SparseMatrix curvature_row(const StructuralSystem& system, double position) {
  const Mesh& mesh = system.mesh;
  if (mesh.elements.empty())
    throw std::invalid_argument("the system has no mesh; expected one, where curvature is read");
  const int node = mesh.node_at(position);
  const auto element = [&](int e) -> const Mesh::Element& {
    return mesh.elements[static_cast<std::size_t>(e)];
  };
  const int count = static_cast<int>(mesh.elements.size());
  const auto alike = [&](int e, int first) {
    return element(e).segment == element(first).segment && element(e).remaining == element(first).remaining &&
           std::abs(element(e).length - element(first).length) <= 1e-9 * element(first).length;
  };
  // Elements on either side over which the section is one, up to four.
  int reach[2] = {0, 0};
  for (const int side : {0, 1}) {
    const int step = side == 0 ? -1 : 1, first = side == 0 ? node - 1 : node;
    for (int e = first; e >= 0 && e < count && reach[side] + 1 < most_nodes && alike(e, first); e += step)
      ++reach[side];
  }
  // In the midst of one section both sides mean the same, and the longer one tells it better.
  if (node > 0 && node < count && alike(node - 1, node) && reach[0] != reach[1])
    reach[reach[0] < reach[1] ? 0 : 1] = 0;
  std::vector<double> of_node(mesh.nodes.size(), 0.0);
  const int sides = (reach[0] > 0) + (reach[1] > 0);
  for (const int side : {0, 1}) {
    if (reach[side] == 0) continue;
    const int step = side == 0 ? -1 : 1;
    const double h = element(side == 0 ? node - 1 : node).length;
    const std::vector<double> weights = derivative_weights(reach[side] + 1);
    for (int k = 0; k <= reach[side]; ++k)
      of_node[static_cast<std::size_t>(node + step * k)] +=
          weights[static_cast<std::size_t>(k)] / (step * h * sides);
  }
  Triplets entries;
  for (Eigen::Index i = 0; i < system.size(); ++i) {
    const Coordinate& coordinate = system.coordinates[static_cast<std::size_t>(i)];
    if (coordinate.kind != Coordinate::Kind::rotation) continue;
    const double weight = of_node[static_cast<std::size_t>(coordinate.node)];
    if (weight != 0.0) entries.emplace_back(0, static_cast<int>(i), weight / coordinate.scale);
  }
  return sparse(1, system.size(), entries);
}

// Values at the nodes, of the coordinates of a kind.

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
