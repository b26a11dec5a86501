#include "fem/parametric_system.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "fem/elements/element.hpp"

namespace beamid::fem {
namespace {

using Eigen::Index;
using Quantity = BeamParameter::Quantity;

// (b - a) / step without the entries that are the same in both.
SparseMatrix difference(const SparseMatrix& a, const SparseMatrix& b, double step) {
  SparseMatrix result = b - a;
  result.prune([](Index, Index, double value) { return value != 0.0; });
  return result / step;
}

// All sections twice as stiff, in shear as in bending: the difference is what the sections contribute to D.
Beam twice_as_stiff(Beam beam) {
  for (Segment& segment : beam.segments) {
    Section& section = segment.section;
    section.bending_stiffness = Variation(2.0) * section.bending_stiffness;
    if (section.shear_stiffness) section.shear_stiffness = Variation(2.0) * *section.shear_stiffness;
  }
  return beam;
}

// The element of each strain that bends one, in their order; -1 for springs, absorbers and chords.
std::vector<int> element_of_strain(const Beam& beam, const Mesh& mesh, const SparseMatrix& bending) {
  std::vector<int> owner(static_cast<std::size_t>(bending.rows()), -1);
  std::size_t element = 0;
  int left = 0;
  for (Index row = 0; row < bending.rows(); ++row) {
    if (bending.coeff(row, row) == 0.0) continue;
    if (left == 0) {
      const Mesh::Element& next = mesh.elements[element++];
      left =
          has_interior(beam.segments[static_cast<std::size_t>(next.segment)].section, next, beam.mass_model)
              ? 4
              : 2;
    }
    owner[static_cast<std::size_t>(row)] = static_cast<int>(element) - 1;
    --left;
  }
  return owner;
}

// Whether all of the region's rigidity goes in proportion with it.
bool bends(const BeamParameter& parameter) {
  return parameter.quantity == Quantity::bending_stiffness ||
         parameter.quantity == Quantity::storey_stiffness;
}

class Differentiation {
 public:
  Differentiation(const Beam& beam, int elements, const std::vector<Point>& points,
                  const std::vector<BeamParameter>& parameters)
      : beam_(beam), elements_(elements), points_(points) {
    for (const BeamParameter& parameter : parameters) {
      result_.values.conservativeResize(result_.values.size() + 1);
      result_.values[result_.values.size() - 1] = value_of(beam, parameter);
      if (parameter.region && bends(parameter))
        beam_ = with_nodes(beam_, {parameter.region->first, parameter.region->second});
      needs_chords_ |= parameter.quantity == Quantity::axial_load && beam.axial_load == 0.0;
    }
    result_.system = assemble(beam_, elements_, points_);
    loaded_ = beam_;
    if (needs_chords_) loaded_.axial_load = load_step();
    const StructuralSystem chorded = needs_chords_ ? assembled(loaded_) : result_.system;
    result_.strain = chorded.stiffness.strain;
    rigidity_ = chorded.stiffness.rigidity;
    if (std::any_of(parameters.begin(), parameters.end(), bends)) {
      bending_ = difference(rigidity_, assembled(twice_as_stiff(loaded_)).stiffness.rigidity, 1.0);
      owner_ = element_of_strain(beam_, result_.system.mesh, bending_);
    }
  }

  ParametricSystem finish(const std::vector<BeamParameter>& parameters) {
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      const double value = result_.values[static_cast<Index>(j)];
      ParametricSystem::Derivative derivative =
          bends(parameters[j]) ? of_bending(parameters[j], value) : of_other(parameters[j], value);
      if (derivative.mass.nonZeros() + derivative.rigidity.nonZeros() + derivative.damping.nonZeros() == 0)
        throw std::invalid_argument("parameter " + std::to_string(j + 1) +
                                    " has no effect: what it would move is held by a support");
      result_.derivatives.push_back(std::move(derivative));
    }
    return std::move(result_);
  }

 private:
  Beam beam_, loaded_;
  int elements_;
  const std::vector<Point>& points_;
  ParametricSystem result_;
  SparseMatrix rigidity_;  // D on the strains of the derivatives
  SparseMatrix bending_;   // what the sections contribute to it
  std::vector<int> owner_;
  bool needs_chords_ = false;

  StructuralSystem assembled(const Beam& beam) const { return assemble(beam, elements_, points_); }

  // A tension so large that its share of an element's rigidity is as large as the section's: with less, the
  // difference would lose the digits by which the section's is larger.
  double load_step() const {
    double h = beam_.length();
    for (const Mesh::Element& element : result_.system.mesh.elements) h = std::min(h, element.length);
    return -value_of(beam_, {Quantity::bending_stiffness, {}}) / (h * h);
  }

  ParametricSystem::Derivative of_bending(const BeamParameter& parameter, double value) const {
    const Mesh& mesh = result_.system.mesh;
    const double slack = 1e-9 * beam_.length();
    const auto [from, to] = parameter.region.value_or(std::pair{0.0, beam_.length()});
    const auto inside = [&, from = from, to = to](Index row) {
      const int element = owner_[static_cast<std::size_t>(row)];
      if (element < 0) return false;
      const Mesh::Element& e = mesh.elements[static_cast<std::size_t>(element)];
      return mesh.nodes[static_cast<std::size_t>(e.first)].x > from - slack &&
             mesh.nodes[static_cast<std::size_t>(e.second)].x < to + slack;
    };
    SparseMatrix rigidity = bending_;
    rigidity.prune([&](Index row, Index, double) { return inside(row); });
    return {SparseMatrix(size(), size()), rigidity / value,
            SparseMatrix(size(), result_.system.inputs.cols())};
  }

  ParametricSystem::Derivative of_other(const BeamParameter& parameter, double value) const {
    const double length = beam_.length(), mass = beam_.mass();
    const double step =
        parameter.quantity == Quantity::axial_load ? load_step()
        : parameter.quantity == Quantity::tip_mass || parameter.quantity == Quantity::body_mass
            ? std::max(value, mass)
        : parameter.quantity == Quantity::tip_rotary_inertia ? std::max(value, mass * length * length)
        : parameter.quantity == Quantity::storey_damping     ? std::max(value, 1.0)
                                                             : value;
    const bool axial = parameter.quantity == Quantity::axial_load;
    const StructuralSystem moved = assembled(axial ? with_load(loaded_.axial_load + step)
                                                   : with_value(loaded_, parameter, value + step));
    const SparseMatrix mass_slope = difference(result_.system.mass, moved.mass, step);
    return {mass_slope, difference(rigidity_, moved.stiffness.rigidity, step),
            difference(result_.system.inputs, moved.inputs, step),
            difference(result_.system.damping, moved.damping, step)};
  }

  Beam with_load(double load) const {
    Beam beam = loaded_;
    beam.axial_load = load;
    return beam;
  }

  Index size() const { return result_.system.size(); }
};

}  // namespace

ParametricSystem assemble_parametric(const Beam& beam, int elements, const std::vector<Point>& points,
                                     const std::vector<BeamParameter>& parameters) {
  return Differentiation(beam, elements, points, parameters).finish(parameters);
}

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
