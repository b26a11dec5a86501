#include "fem/gauge_row.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "fem/triplets.hpp"

namespace beamid::fem {
namespace {

using Kind = Coordinate::Kind;

bool is_clamped(const StructuralSystem& system, int node) {
  return std::none_of(system.coordinates.begin(), system.coordinates.end(),
                      [&](const Coordinate& one) { return one.node == node; });
}

bool is_uniform(const Beam& beam, const Mesh::Element& element) {
  return beam.segments[static_cast<std::size_t>(element.segment)].section.is_uniform();
}

/// theta' at the clamped end of an element: of (w, h theta) at its other end, and of its interior coordinates
/// (uniform_shape(), interior_shape() in elements/element_shapes.hpp).
void add_end_curvature(const StructuralSystem& system, const Beam& beam, const Mesh::Element& element,
                       bool clamped_first, double weight, Triplets& entries) {
  const Section& section = beam.segments[static_cast<std::size_t>(element.segment)].section;
  const double h = element.length, square = h * h;
  const double phi = section.shear_stiffness ? 12.0 * element.remaining * section.bending_stiffness(0.0) /
                                                   ((*section.shear_stiffness)(0.0) * square)
                                             : 0.0;
  const int other = clamped_first ? element.second : element.first;
  const double of_deflection = 6.0 / (1.0 + phi),
               of_rotation = (clamped_first ? -2.0 + phi : 2.0 - phi) / (1.0 + phi);
  const double middle = system.mesh.nodes[static_cast<std::size_t>(element.first)].x + 0.5 * h;
  int inside = 0;
  for (Eigen::Index i = 0; i < system.size(); ++i) {
    const Coordinate& one = system.coordinates[static_cast<std::size_t>(i)];
    double value = 0.0;
    if (one.node == other && one.kind == Kind::deflection) value = of_deflection;
    if (one.node == other && one.kind == Kind::rotation) value = of_rotation * h / one.scale;
    if (one.node < 0 && std::abs(one.position - middle) < 0.25 * h)
      value = inside++ == 0 ? 2.0 : clamped_first ? 4.0 : -4.0;
    if (value != 0.0) entries.emplace_back(0, static_cast<int>(i), weight * value / square);
  }
}

}  // namespace

SparseMatrix gauge_row(const StructuralSystem& system, const Beam& beam, double position) {
  SparseMatrix elsewhere = curvature_row(system, position);
  const int node = system.mesh.node_at(position);
  std::vector<const Mesh::Element*> around;
  for (const Mesh::Element& element : system.mesh.elements)
    if (element.first == node || element.second == node) around.push_back(&element);
  const bool uniform = std::all_of(around.begin(), around.end(),
                                   [&](const Mesh::Element* one) { return is_uniform(beam, *one); });
  if (!uniform || beam.axial_load != 0.0 || beam.mass_model != MassModel::consistent ||
      !is_clamped(system, node))
    return elsewhere;
  Triplets entries;
  for (const Mesh::Element* one : around)
    add_end_curvature(system, beam, *one, one->first == node, 1.0 / static_cast<double>(around.size()),
                      entries);
  return sparse(1, system.size(), entries);
}

}  // namespace beamid::fem
