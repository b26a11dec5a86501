#include "fem/exact/beam_chain.hpp"

#include "fem/mesh.hpp"

namespace beamid::fem {
namespace {

double added_mass(const Beam& beam, double place) {
  double sum = 0.0;
  for (const AddedMass& added : beam.added_masses)
    if (added.from < place && place < added.to) sum += added.mass_per_length;
  return sum;
}

}  // namespace

std::optional<HarmonicChain> chain_of(const Beam& beam) {
  const Mesh mesh = cut(beam, 1);
  HarmonicChain chain;
  for (const Mesh::Node& node : mesh.nodes) chain.nodes.push_back({.position = node.x, .absorbers = {}});
  for (const Mesh::Element& element : mesh.elements) {
    const Section& section = beam.segments[element.segment].section;
    if (!section.is_uniform()) return {};
    UniformPiece piece;
    piece.length = element.length;
    piece.bending_stiffness = element.remaining * section.bending_stiffness(0.0);
    piece.mass_per_length =
        section.mass_per_length(0.0) + added_mass(beam, mesh.nodes[element.first].x + 0.5 * element.length);
    piece.rotary_inertia = section.rotary_inertia(0.0);
    piece.shear_flexibility = section.shear_stiffness ? 1.0 / (*section.shear_stiffness)(0.0) : 0.0;
    piece.axial_load = beam.axial_load;
    if (piece.shear_flexibility * piece.axial_load > 0.4) return {};
    chain.pieces.push_back(piece);
  }
  const auto at = [&](double x) -> HarmonicNode& { return chain.nodes[mesh.node_at(x)]; };
  for (const Body& body : beam.bodies) {
    const double first = body.mass * body.eccentricity,
                 second = first * body.eccentricity + body.rotary_inertia;
    at(body.position).mass += Eigen::Matrix2d{{body.mass, first}, {first, second}};
  }
  for (const Spring& spring : beam.springs) {
    at(spring.position).stiffness(0, 0) += spring.translational;
    at(spring.position).stiffness(1, 1) += spring.rotational;
  }
  for (const Absorber& absorber : beam.absorbers)
    at(absorber.position).absorbers.push_back({absorber.mass, absorber.stiffness});
  for (const Support& support : beam.supports) {
    at(support.position).held[0] |= support.deflection;
    at(support.position).held[1] |= support.rotation;
  }
  return chain;
}

std::vector<HarmonicChain> split_where_clamped(const HarmonicChain& whole) {
  std::vector<HarmonicChain> parts(1);
  for (std::size_t i = 0; i < whole.nodes.size(); ++i) {
    parts.back().nodes.push_back(whole.nodes[i]);
    if (i + 1 == whole.nodes.size()) break;
    if (i > 0 && whole.nodes[i].is_clamped()) {
      parts.emplace_back().nodes.push_back(whole.nodes[i]);
      parts.back().nodes.back().absorbers.clear();
    }
    parts.back().pieces.push_back(whole.pieces[i]);
  }
  return parts;
}

Eigen::Matrix2Xd rigid_motions(const HarmonicChain& chain) {
  bool turning_held = chain.pieces.front().axial_load != 0.0, held = false;
  double pivot = 0.0, mass = 0.0, moment = 0.0;
  for (const HarmonicNode& node : chain.nodes) {
    turning_held |= node.held[1] || node.stiffness(1, 1) > 0.0;
    if (node.held[0] || node.stiffness(0, 0) > 0.0) {
      turning_held |= held;
      held = true;
      pivot = node.position;
    }
    mass += node.mass(0, 0);
    moment += node.mass(0, 0) * node.position + node.mass(0, 1);
    for (const auto& absorber : node.absorbers)
      mass += absorber.mass, moment += absorber.mass * node.position;
  }
  for (std::size_t i = 0; i < chain.pieces.size(); ++i) {
    const double part = chain.pieces[i].mass_per_length * chain.pieces[i].length;
    mass += part;
    moment += part * 0.5 * (chain.nodes[i].position + chain.nodes[i + 1].position);
  }
  if (!held) pivot = moment / mass;
  Eigen::Matrix2Xd motions(2, !held + !turning_held);
  if (!held) motions.col(0) << 1.0, 0.0;
  if (!turning_held) motions.rightCols(1) << -pivot, 1.0;
  return motions;
}

}  // namespace beamid::fem
