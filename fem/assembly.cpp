#include "fem/assembly.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>

#include "fem/elements/element.hpp"
#include "fem/parametric_system.hpp"

namespace beamid::fem {
namespace {

using Kind = Coordinate::Kind;

double added_mass(const Beam& beam, const Mesh& mesh, const Mesh::Element& element) {
  const double middle = 0.5 * (mesh.nodes[element.first].x + mesh.nodes[element.second].x);
  double sum = 0.0;
  for (const AddedMass& added : beam.added_masses)
    if (added.from < middle && middle < added.to) sum += added.mass_per_length;
  return sum;
}

// Gathers the equations of one beam. Rows of the strains are written node by node: the springs of a node,
// then the element beyond it, so that they determine the coordinates in their order.
class Assembly {
 public:
  Assembly(const Beam& beam, const Mesh& mesh) : beam_(beam), mesh_(mesh) { number(); }

  StructuralSystem finish(const std::vector<Point>& points) {
    add_springs(0);
    for (std::size_t e = 0; e < mesh_.elements.size(); ++e) {
      add_element(e);
      add_springs(mesh_.elements[e].second);
    }
    for (const Body& body : beam_.bodies) add_body(body);
    for (const Dashpot& dashpot : beam_.dashpots) add_dashpot(dashpot);
    const auto n = static_cast<Eigen::Index>(system_.coordinates.size());
    if (n == 0) throw std::invalid_argument("the supports hold every node; expected some freedom");
    add_points(points, n);
    system_.mass = sparse(n, n, mass_);
    Triplets().swap(mass_);
    system_.damping = sparse(n, n, damping_);
    system_.stiffness = {sparse(strains_, n, strain_), sparse(strains_, strains_, rigid_),
                         sparse(strains_, strains_, flexible_)};
    system_.mesh = mesh_;
    return std::move(system_);
  }

 private:
  const Beam& beam_;
  const Mesh& mesh_;
  StructuralSystem system_;
  std::vector<int> deflection_, rotation_;  // coordinate of each node, -1 where supported
  std::vector<int> absorber_;               // coordinate of each absorber
  std::vector<int> interior_;               // first of the two inside each element, -1 where it has none
  std::vector<double> scale_;               // of the rotation at each node
  Triplets mass_, damping_, strain_, rigid_, flexible_;
  std::vector<double> base_;  // force of a unit acceleration of the base, on the free coordinates
  int strains_ = 0;
  // An element like the one before has the same matrices.
  Mesh::Element previous_;
  double previous_added_ = 0.0;
  ElementMatrices matrices_;

  void number() {
    absorber_.resize(beam_.absorbers.size());
    std::map<int, Support> held;
    for (const Support& support : beam_.supports) {
      Support& both =
          held.try_emplace(mesh_.node_at(support.position), Support{0.0, false, false}).first->second;
      both.deflection |= support.deflection;
      both.rotation |= support.rotation;
    }
    for (std::size_t node = 0; node < mesh_.nodes.size(); ++node) {
      const auto support = held.find(static_cast<int>(node));
      scale_.push_back(mesh_.elements[node == 0 ? 0 : node - 1].length);
      const auto coordinate = [&](bool is_held, Kind kind, double scale) {
        if (is_held) return -1;
        system_.coordinates.push_back({kind, mesh_.nodes[node].x, scale, static_cast<int>(node)});
        return static_cast<int>(system_.coordinates.size()) - 1;
      };
      const bool known = support != held.end();
      deflection_.push_back(coordinate(known && support->second.deflection, Kind::deflection, 1.0));
      rotation_.push_back(coordinate(known && support->second.rotation, Kind::rotation, scale_.back()));
      for (std::size_t i = 0; i < absorber_.size(); ++i)
        if (mesh_.node_at(beam_.absorbers[i].position) == static_cast<int>(node)) {
          absorber_[i] = static_cast<int>(system_.coordinates.size());
          system_.coordinates.push_back({Kind::generalised, mesh_.nodes[node].x, 1.0, -1});
        }
      if (node == mesh_.elements.size()) break;
      const Mesh::Element& element = mesh_.elements[node];
      const bool inside = has_interior(beam_.segments[element.segment].section, element, beam_.mass_model);
      interior_.push_back(inside ? static_cast<int>(system_.coordinates.size()) : -1);
      if (inside)
        system_.coordinates.insert(system_.coordinates.end(), 2,
                                   {Kind::generalised, mesh_.nodes[node].x + 0.5 * element.length, 1.0, -1});
    }
    base_.assign(system_.coordinates.size(), 0.0);
  }

  void add_strain(int row, int coordinate, double value) {
    if (coordinate >= 0 && value != 0.0) strain_.emplace_back(row, coordinate, value);
  }

  void add_ground_strain(int coordinate, double rigidity) {
    if (coordinate < 0 || rigidity == 0.0) return;
    add_strain(strains_, coordinate, 1.0);
    rigid_.emplace_back(strains_, strains_, rigidity);
    flexible_.emplace_back(strains_, strains_, 1.0 / rigidity);
    ++strains_;
  }

  void add_springs(int node) {
    for (const Spring& spring : beam_.springs) {
      if (mesh_.node_at(spring.position) != node) continue;
      add_ground_strain(deflection_[node], spring.translational);
      add_ground_strain(rotation_[node], spring.rotational / (scale_[node] * scale_[node]));
      if (spring.cubic != 0.0) add_nonlinear(node, spring.cubic, 0.0);
    }
    for (std::size_t i = 0; i < absorber_.size(); ++i)
      if (mesh_.node_at(beam_.absorbers[i].position) == node) add_absorber(i, deflection_[node]);
  }

  // Its strain is its travel, w_absorber - w.
  void add_absorber(std::size_t i, int w) {
    const Absorber& absorber = beam_.absorbers[i];
    add_strain(strains_, absorber_[i], 1.0);
    add_strain(strains_, w, -1.0);
    rigid_.emplace_back(strains_, strains_, absorber.stiffness);
    flexible_.emplace_back(strains_, strains_, 1.0 / absorber.stiffness);
    ++strains_;
    add_mass(absorber_[i], absorber_[i], absorber.mass, true);
    if (absorber.damping == 0.0) return;
    damping_.emplace_back(absorber_[i], absorber_[i], absorber.damping);
    if (w < 0) return;
    damping_.emplace_back(w, w, absorber.damping);
    damping_.emplace_back(w, absorber_[i], -absorber.damping);
    damping_.emplace_back(absorber_[i], w, -absorber.damping);
  }

  void add_nonlinear(int node, double cubic, double quadratic) {
    if (deflection_[node] < 0) return;
    const auto n = static_cast<Eigen::Index>(system_.coordinates.size());
    system_.nonlinear_forces.push_back({sparse(n, 1, {{deflection_[node], 0, 1.0}}), cubic, quadratic});
  }

  void add_mass(int row, int column, double value, bool column_deflects) {
    if (row < 0 || value == 0.0) return;
    if (column >= 0) mass_.emplace_back(row, column, value);
    if (column_deflects) base_[row] -= value;
  }

  void add_element(std::size_t e) {
    const Mesh::Element& element = mesh_.elements[e];
    const Section& section = beam_.segments[element.segment].section;
    const double added = beam_.added_masses.empty() ? 0.0 : added_mass(beam_, mesh_, element);
    const bool same = e > 0 && section.is_uniform() && element.segment == previous_.segment &&
                      element.length == previous_.length && element.remaining == previous_.remaining &&
                      added == previous_added_;
    if (!same) matrices_ = element_matrices(section, element, added, beam_.axial_load, beam_.mass_model);
    previous_ = element;
    previous_added_ = added;

    const double h = element.length;
    const int first = element.first, second = element.second;
    const int inside = interior_[e], beyond = inside < 0 ? -1 : inside + 1;
    const int at[6] = {deflection_[first], rotation_[first], deflection_[second],
                       rotation_[second],  inside,           beyond};
    const double ratio[6] = {1.0, h / scale_[first], 1.0, h / scale_[second], 1.0,
                             1.0};  // h theta per coordinate
    const int coordinates = matrices_.interior ? 6 : 4, strains = coordinates - 2;
    for (int i = 0; i < coordinates; ++i)
      for (int j = 0; j < coordinates; ++j) {
        const double mass = matrices_.interior ? matrices_.interior->mass(i, j) : matrices_.mass(i, j);
        add_mass(at[i], at[j], ratio[i] * mass * ratio[j], j == 0 || j == 2);
      }
    const double drift[4] = {1.0, ratio[1], -1.0, 0.0}, turn[4] = {0.0, -ratio[1], 0.0, ratio[3]};
    for (int i = 0; i < 4; ++i) {
      add_strain(strains_, at[i], drift[i]);
      add_strain(strains_ + 1, at[i], turn[i]);
    }
    for (int i = 2; i < strains; ++i) add_strain(strains_ + i, at[i + 2], 1.0);
    for (int i = 0; i < strains; ++i)
      for (int j = 0; j < strains; ++j) {
        const bool inner = matrices_.interior.has_value();
        rigid_.emplace_back(strains_ + i, strains_ + j,
                            inner ? matrices_.interior->rigidity(i, j) : matrices_.rigidity(i, j));
        flexible_.emplace_back(strains_ + i, strains_ + j,
                               inner ? matrices_.interior->flexibility(i, j) : matrices_.flexibility(i, j));
      }
    strains_ += strains;
    add_storey_dashpot(beam_.segments[element.segment].dashpot, at[0], at[2]);
    if (beam_.axial_load != 0.0) {  // the chord, w_2 - w_1
      add_strain(strains_, at[0], -1.0);
      add_strain(strains_, at[2], 1.0);
      rigid_.emplace_back(strains_, strains_, -beam_.axial_load / h);
      flexible_.emplace_back(strains_, strains_, -h / beam_.axial_load);
      ++strains_;
    }
  }

  void add_storey_dashpot(double c, int below, int above) {
    if (c == 0.0) return;
    for (const auto& [row, column, value] :
         {std::tuple{below, below, c}, {above, above, c}, {below, above, -c}, {above, below, -c}})
      if (row >= 0 && column >= 0) damping_.emplace_back(row, column, value);
  }

  // M (w + e theta)^2 + J theta^2
  void add_body(const Body& body) {
    const int node = mesh_.node_at(body.position), w = deflection_[node], turn = rotation_[node];
    const double s = scale_[node], e = body.eccentricity;
    add_mass(w, w, body.mass, true);
    add_mass(w, turn, body.mass * e / s, false);
    add_mass(turn, w, body.mass * e / s, true);
    add_mass(turn, turn, (body.mass * e * e + body.rotary_inertia) / (s * s), false);
  }

  void add_dashpot(const Dashpot& dashpot) {
    const int node = mesh_.node_at(dashpot.position), w = deflection_[node], turn = rotation_[node];
    if (w >= 0 && dashpot.translational != 0.0) damping_.emplace_back(w, w, dashpot.translational);
    if (turn >= 0 && dashpot.rotational != 0.0)
      damping_.emplace_back(turn, turn, dashpot.rotational / (scale_[node] * scale_[node]));
    if (dashpot.quadratic != 0.0) add_nonlinear(node, 0.0, dashpot.quadratic);
  }

  void add_points(const std::vector<Point>& points, Eigen::Index n) {
    Triplets inputs, outputs;
    const auto count = static_cast<int>(points.size());
    for (int i = 0; i < count; ++i) {
      const int node = mesh_.node_at(points[i].position);
      const bool rotates = points[i].rotates;
      const int at = rotates ? rotation_[node] : deflection_[node];
      if (at < 0)
        throw std::invalid_argument("point '" + points[i].name + "' is held by a support" +
                                    (rotates ? ", or does not rotate" : "") + "; expected one that can move");
      const double share = rotates ? 1.0 / scale_[node] : 1.0;  // of the point's motion in the coordinate
      inputs.emplace_back(at, i, share);
      outputs.emplace_back(i, at, share);
      system_.input_names.push_back(points[i].name + (rotates ? "_moment" : "_force"));
      system_.output_names.push_back(points[i].name + (rotates ? "_rotation" : "_deflection"));
      if (!rotates) continue;
      if (system_.base_shares.size() == 0) system_.base_shares.setOnes(count);
      system_.base_shares[i] = 0.0;
    }
    for (Eigen::Index i = 0; i < n; ++i)
      if (base_[i] != 0.0) inputs.emplace_back(static_cast<int>(i), count, base_[i]);
    system_.input_names.emplace_back("base_acceleration");
    system_.inputs = sparse(n, count + 1, inputs);
    system_.outputs = sparse(count, n, outputs);
  }
};

}  // namespace

StructuralSystem assemble(const Beam& beam, int elements, const std::vector<Point>& points) {
  return assemble_refined(beam, elements, 1, points);
}

StructuralSystem assemble_refined(const Beam& beam, int elements, int parts,
                                  const std::vector<Point>& points) {
  std::vector<double> places;
  for (const Point& point : points) places.push_back(point.position);
  const Mesh coarse = cut(beam, elements, places);
  const Mesh mesh = parts == 1 || beam.shear_building ? coarse : refined(coarse, parts);
  return Assembly(beam, mesh).finish(points);
}

StructuralSystem assemble(const Beam& beam, int elements) {
  validate(beam);
  return assemble(beam, elements, {natural_point(beam)});
}

Point natural_point(const Beam& beam) {
  const double length = beam.length(), same_place = 1e-9 * length;
  std::vector<double> held;
  for (const Support& support : beam.supports)
    if (support.deflection) held.push_back(support.position);
  std::sort(held.begin(), held.end());
  const bool sharp_tip = beam.segments.back().section.bending_stiffness(1.0) <= 0.0;  // bears no force
  if (!sharp_tip && (held.empty() || held.back() < length - same_place)) return {"tip", length};
  if (held.empty() || sharp_tip) return {"midspan", 0.5 * length};
  held.insert(held.begin(), 0.0);  // a free root bounds the first span
  std::size_t longest = 1;
  for (std::size_t i = 1; i < held.size(); ++i)
    if (held[i] - held[i - 1] > (held[longest] - held[longest - 1]) * (1 + 1e-9)) longest = i;
  return {"midspan", 0.5 * (held[longest - 1] + held[longest])};
}

Mesh refined(const Mesh& mesh, int parts) {
  if (parts < 1)
    throw std::invalid_argument("parts of an element are " + std::to_string(parts) + "; expected at least 1");
  Mesh fine;
  fine.nodes.push_back(mesh.nodes.front());
  for (const Mesh::Element& whole : mesh.elements) {
    const Mesh::Node &a = mesh.nodes[static_cast<std::size_t>(whole.first)],
                     &b = mesh.nodes[static_cast<std::size_t>(whole.second)];
    for (int i = 1; i <= parts; ++i) {
      const double begin = static_cast<double>(i - 1) / parts, end = static_cast<double>(i) / parts;
      Mesh::Element part = whole;
      part.first = static_cast<int>(fine.nodes.size()) - 1;
      part.second = part.first + 1;
      part.length = whole.length / parts;
      part.from = whole.from + begin * (whole.to - whole.from);
      part.to = i == parts ? whole.to : whole.from + end * (whole.to - whole.from);
      fine.elements.push_back(part);
      fine.nodes.push_back(i == parts ? b : Mesh::Node{a.x + end * (b.x - a.x), a.y + end * (b.y - a.y)});
    }
  }
  return fine;
}

}  // namespace beamid::fem
