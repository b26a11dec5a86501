#include <algorithm>
#include <stdexcept>
#include <string>

#include "fem/elements/element.hpp"
#include "fem/elements/frame_element.hpp"
#include "fem/frame.hpp"
#include "fem/frame_graph.hpp"
#include "fem/triplets.hpp"

namespace beamid::fem {
namespace {

using Kind = Coordinate::Kind;

// A rotation, and the length that scales it.
struct Turn {
  int coordinate = -1;  // -1: held
  double scale = 1.0;
};

struct NodeCoordinates {
  int u = -1, v = -1;  // -1: held
  Turn turn;
  bool known = false;
};

Section stiffened(const Frame::Member& member) {
  Section section = member.section;
  if (member.stiffness_factor == 1.0) return section;
  const Variation factor(member.stiffness_factor);
  section.bending_stiffness = factor * section.bending_stiffness;
  for (auto* const rigidity : {&section.shear_stiffness, &section.axial_stiffness})
    if (*rigidity) *rigidity = factor * **rigidity;
  return section;
}

class FrameAssembly {
 public:
  FrameAssembly(const Frame& frame, int elements) : frame_(frame), elements_(elements) {
    for (const Frame::Joint& joint : frame.joints) system_.mesh.nodes.push_back({joint.x, joint.y});
    nodes_.resize(frame.joints.size());
    held_.resize(frame.joints.size(), {0, false, false, false});
    for (const Frame::Support& support : frame.supports) {
      Frame::Support& both = held_[support.joint];
      both.x |= support.x, both.y |= support.y, both.rotation |= support.rotation;
    }
    for (const Frame::Member& member : frame.members) {  // joints without any rigid connection
      for (const auto& [joint, hinged] :
           {std::pair{member.first, member.hinged_at_first}, {member.second, member.hinged_at_second}})
        if (!hinged) rigid_joints_.push_back(joint);
    }
  }

  StructuralSystem finish(const std::vector<FramePoint>& points) {
    std::vector<int> held;
    for (const Frame::Support& of_joint : held_)
      held.push_back(int{of_joint.x} + int{of_joint.y} + int{of_joint.rotation});
    for (const FrameStep& step : walk(held, member_ends(frame_))) add_member(step);
    const auto n = static_cast<Eigen::Index>(system_.coordinates.size());
    if (n == 0) throw std::invalid_argument("the supports hold every joint; expected some freedom");
    for (const Frame::Body& body : frame_.bodies) {
      const NodeCoordinates& node = nodes_[body.joint];
      add_mass(node.u, node.u, body.mass, 0);
      add_mass(node.v, node.v, body.mass, 1);
      add_mass(node.turn.coordinate, node.turn.coordinate,
               body.rotary_inertia / (node.turn.scale * node.turn.scale), 2);
    }
    for (const Frame::Dashpot& dashpot : frame_.dashpots) {
      const NodeCoordinates& node = nodes_[dashpot.joint];
      add_damping(node.u, dashpot.x);
      add_damping(node.v, dashpot.y);
      add_damping(node.turn.coordinate, dashpot.rotational / (node.turn.scale * node.turn.scale));
    }
    add_points(points, n);
    system_.mass = sparse(n, n, mass_);
    system_.damping = sparse(n, n, damping_);
    system_.stiffness = {sparse(strains_, n, strain_), sparse(strains_, strains_, rigid_),
                         sparse(strains_, strains_, flexible_)};
    return std::move(system_);
  }

 private:
  const Frame& frame_;
  const int elements_;
  StructuralSystem system_;
  std::vector<NodeCoordinates> nodes_;
  std::vector<Frame::Support> held_;
  std::vector<int> rigid_joints_;  // those whose rotation some member shares
  Triplets mass_, damping_, strain_, rigid_, flexible_, base_;
  int strains_ = 0;

  int add_coordinate(Kind kind, int node, double scale) {
    const bool nodal = kind != Kind::generalised;
    system_.coordinates.push_back({kind, system_.mesh.nodes[node].x, scale, nodal ? node : -1});
    return static_cast<int>(system_.coordinates.size()) - 1;
  }

  void know(int node, double scale, const Frame::Support& held) {
    NodeCoordinates& known = nodes_[node];
    known.known = true;
    if (!held.x) known.u = add_coordinate(Kind::axial, node, 1.0);
    if (!held.y) known.v = add_coordinate(Kind::deflection, node, 1.0);
    known.turn.scale = scale;
    if (!held.rotation) known.turn.coordinate = add_coordinate(Kind::rotation, node, scale);
  }

  // Rotation of a member's end: its joint's, or its own beyond a hinge.
  Turn end_turn(int joint, bool hinged, double length) {
    if (!hinged) return nodes_[joint].turn;
    if (!held_[joint].rotation &&
        std::find(rigid_joints_.begin(), rigid_joints_.end(), joint) == rigid_joints_.end()) {
      rigid_joints_.push_back(joint);
      return nodes_[joint].turn;
    }
    return {add_coordinate(Kind::generalised, joint, length), length};
  }

  void add_member(const FrameStep& step) {
    const Frame::Member& member = frame_.members[step.member];
    const Frame::Joint &begin = frame_.joints[step.from], &end = frame_.joints[step.to];
    const double length = frame_.length(step.member);
    const Eigen::Vector2d direction((end.x - begin.x) / length, (end.y - begin.y) / length);
    Mesh::Element element;
    element.segment = static_cast<int>(step.member);
    element.length = length / elements_;
    if (!nodes_[step.from].known) {
      know(step.from, element.length, held_[step.from]);
      add_springs(step.from);
    }
    int node = step.from;
    Turn turn =
        end_turn(node, step.reversed ? member.hinged_at_second : member.hinged_at_first, element.length);
    FrameElementMatrices matrices;
    for (int e = 0; e < elements_; ++e) {
      const auto place = [&](int i) {
        const double s = static_cast<double>(i) / elements_;
        return step.reversed ? 1.0 - s : s;
      };
      element.from = place(e), element.to = place(e + 1);
      element.first = node;
      element.second =
          e + 1 == elements_ ? step.to : add_node(begin, end, static_cast<double>(e + 1) / elements_);
      if (e == 0 || !member.section.is_uniform())
        matrices = frame_element_matrices(stiffened(member), element, direction, member.axial_load,
                                          frame_.mass_model);
      const int inside = matrices.strain.cols() > 6 ? add_coordinate(Kind::generalised, node, 1.0) : -1;
      if (inside >= 0) add_coordinate(Kind::generalised, node, 1.0);
      const bool reaches = !nodes_[element.second].known;
      if (reaches) know(element.second, element.length, e + 1 == elements_ ? held_[step.to] : free());
      const Turn next =
          e + 1 == elements_
              ? end_turn(step.to, step.reversed ? member.hinged_at_first : member.hinged_at_second,
                         element.length)
              : nodes_[element.second].turn;
      add_element(element, matrices, turn, next, inside);
      if (reaches && e + 1 == elements_) add_springs(step.to);
      node = element.second;
      turn = next;
    }
  }

  static Frame::Support free() { return {0, false, false, false}; }

  int add_node(const Frame::Joint& begin, const Frame::Joint& end, double s) {
    system_.mesh.nodes.push_back({begin.x + s * (end.x - begin.x), begin.y + s * (end.y - begin.y)});
    nodes_.emplace_back();
    return static_cast<int>(nodes_.size()) - 1;
  }

  void add_element(const Mesh::Element& element, const FrameElementMatrices& matrices, const Turn& first,
                   const Turn& second, int inside) {
    system_.mesh.elements.push_back(element);
    const NodeCoordinates &one = nodes_[element.first], &two = nodes_[element.second];
    const int at[8] = {one.u, one.v, first.coordinate, two.u, two.v, second.coordinate, inside, inside + 1};
    const double h = element.length;
    const double ratio[8] = {1, 1, h / first.scale, 1, 1, h / second.scale, 1, 1};  // h theta per coordinate
    const auto strains = static_cast<int>(matrices.strain.rows());
    const auto coordinates = static_cast<int>(matrices.strain.cols());
    for (int i = 0; i < coordinates; ++i)
      for (int j = 0; j < coordinates; ++j)
        add_mass(at[i], at[j], ratio[i] * matrices.mass(i, j) * ratio[j], j < 6 ? j % 3 : 2);
    for (int row = 0; row < strains; ++row)
      for (int j = 0; j < coordinates; ++j)
        if (at[j] >= 0 && matrices.strain(row, j) != 0.0)
          strain_.emplace_back(strains_ + row, at[j], matrices.strain(row, j) * ratio[j]);
    for (int i = 0; i < strains; ++i)
      for (int j = 0; j < strains; ++j) {
        if (matrices.rigidity(i, j) != 0.0)
          rigid_.emplace_back(strains_ + i, strains_ + j, matrices.rigidity(i, j));
        if (matrices.flexibility(i, j) != 0.0)
          flexible_.emplace_back(strains_ + i, strains_ + j, matrices.flexibility(i, j));
      }
    strains_ += strains;
  }

  // `direction` of the column: 0: x, 1: y, 2: a rotation.
  void add_mass(int row, int column, double value, int direction) {
    if (row < 0 || value == 0.0) return;
    if (column >= 0) mass_.emplace_back(row, column, value);
    if (direction < 2) base_.emplace_back(row, direction, -value);
  }

  void add_damping(int coordinate, double value) {
    if (coordinate >= 0 && value != 0.0) damping_.emplace_back(coordinate, coordinate, value);
  }

  void add_springs(int joint) {
    const auto add = [&](int coordinate, double rigidity) {
      if (coordinate < 0 || rigidity == 0.0) return;
      strain_.emplace_back(strains_, coordinate, 1.0);
      rigid_.emplace_back(strains_, strains_, rigidity);
      flexible_.emplace_back(strains_, strains_, 1.0 / rigidity);
      ++strains_;
    };
    const NodeCoordinates& node = nodes_[joint];
    for (const Frame::Spring& spring : frame_.springs) {
      if (spring.joint != joint) continue;
      add(node.u, spring.x);
      add(node.v, spring.y);
      add(node.turn.coordinate, spring.rotational / (node.turn.scale * node.turn.scale));
    }
  }

  void add_points(const std::vector<FramePoint>& points, Eigen::Index n) {
    Triplets inputs, outputs;
    int count = 0;
    for (const FramePoint& point : points) {
      if (point.joint < 0 || point.joint >= static_cast<int>(frame_.joints.size()))
        throw std::invalid_argument("point '" + point.name + "' is at joint " + std::to_string(point.joint) +
                                    "; expected 0 to " + std::to_string(frame_.joints.size() - 1));
      const NodeCoordinates& node = nodes_[point.joint];
      if (node.u < 0 && node.v < 0)
        throw std::invalid_argument("point '" + point.name +
                                    "' is held by a support; expected one that can move");
      for (const auto& [coordinate, axis] : {std::pair{node.u, "_x"}, {node.v, "_y"}}) {
        if (coordinate < 0) continue;
        inputs.emplace_back(coordinate, count, 1.0);
        outputs.emplace_back(count, coordinate, 1.0);
        system_.input_names.push_back(point.name + "_force" + axis);
        system_.output_names.push_back(point.name + "_displacement" + axis);
        ++count;
      }
    }
    for (const auto& entry : base_) inputs.emplace_back(entry.row(), count + entry.col(), entry.value());
    system_.input_names.insert(system_.input_names.end(), {"base_acceleration_x", "base_acceleration_y"});
    system_.inputs = sparse(n, count + 2, inputs);
    system_.outputs = sparse(count, n, outputs);
  }
};

}  // namespace

StructuralSystem assemble(const Frame& frame, int elements_per_member,
                          const std::vector<FramePoint>& points) {
  validate(frame);
  if (elements_per_member < 1)
    throw std::invalid_argument("elements per member is " + std::to_string(elements_per_member) +
                                "; expected at least 1");
  return FrameAssembly(frame, elements_per_member).finish(points);
}

}  // namespace beamid::fem
