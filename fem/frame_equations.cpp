#include "fem/frame_equations.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include <Eigen/Core>

#include "fem/beam.hpp"
#include "fem/elements/element.hpp"
#include "fem/frame.hpp"

namespace beamid::fem {

using Eigen::Index;

void FrameEquations::add_mass(int row, int column, double value, int direction) {
  if (row < 0 || value == 0.0) return;
  if (column >= 0) mass_.emplace_back(row, column, value);
  if (direction >= 0) base_.emplace_back(row, direction, -value);
}

void FrameEquations::add_damping(int coordinate, double value) {
  if (coordinate >= 0 && value != 0.0) damping_.emplace_back(coordinate, coordinate, value);
}

void FrameEquations::add_strain(int strain, int coordinate, double value) {
  if (coordinate >= 0 && value != 0.0) strain_.emplace_back(strain, coordinate, value);
}

void FrameEquations::add_rigidity(const Eigen::MatrixXd& rigidity, const Eigen::MatrixXd& flexibility) {
  const auto count = static_cast<int>(rigidity.rows());
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      if (rigidity(i, j) != 0.0) rigidity_.emplace_back(strains_ + i, strains_ + j, rigidity(i, j));
      if (flexibility(i, j) != 0.0) flexibility_.emplace_back(strains_ + i, strains_ + j, flexibility(i, j));
    }
  strains_ += count;
}

void FrameEquations::add_ground_spring(int coordinate, double rigidity) {
  if (coordinate < 0 || rigidity == 0.0) return;
  add_strain(strains_, coordinate, 1.0);
  rigidity_.emplace_back(strains_, strains_, rigidity);
  flexibility_.emplace_back(strains_, strains_, 1.0 / rigidity);
  ++strains_;
}

void FrameEquations::add_point(const std::string& name, const std::vector<int>& coordinates) {
  bool moves = false;
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
    if (coordinates[axis] < 0) continue;
    const auto place = static_cast<int>(output_names_.size());
    inputs_.emplace_back(coordinates[axis], place, 1.0);
    outputs_.emplace_back(place, coordinates[axis], 1.0);
    input_names_.push_back(name + "_force_" + axes_[axis]);
    output_names_.push_back(name + "_displacement_" + axes_[axis]);
    moves = true;
  }
  if (!moves)
    throw std::invalid_argument("point '" + name + "' is held by a support; expected one that can move");
}

void FrameEquations::put_into(StructuralSystem& system) const {
  const auto n = static_cast<Index>(system.coordinates.size());
  const auto points = static_cast<int>(output_names_.size());
  Triplets inputs = inputs_;
  for (const auto& entry : base_) inputs.emplace_back(entry.row(), points + entry.col(), entry.value());
  system.mass = sparse(n, n, mass_);
  system.damping = sparse(n, n, damping_);
  system.stiffness = {sparse(strains_, n, strain_), sparse(strains_, strains_, rigidity_),
                      sparse(strains_, strains_, flexibility_)};
  system.inputs = sparse(n, points + static_cast<Index>(axes_.size()), inputs);
  system.outputs = sparse(points, n, outputs_);
  system.input_names = input_names_;
  for (const char axis : axes_) system.input_names.push_back(std::string("base_acceleration_") + axis);
  system.output_names = output_names_;
}

namespace {

// One element of a frame: what a beam element does, and its elongation.

/// Matrices of one element between nodes 1 and 2 in the frame's axes.
///
/// Coordinates: (u_1, v_1, h theta_1, u_2, v_2, h theta_2), and behind them the interior ones of bending (two
/// or none, element.hpp) and of stretching (one or none, element.hpp). With the direction t of the
/// element, n = t turned by 90 degrees, and the strains of element.hpp, the strains here are
///
///     (t elongation - n epsilon_1, epsilon_2)   [m],
///
/// the interior coordinates themselves and, under an axial load P, the chord n (u_2 - u_1, v_2 - v_1) of
/// rigidity -P/h, last.
struct FrameElementMatrices {
  Eigen::MatrixXd strain;  ///< (3 x 6), with i interior ones (3 + i x 6 + i), a row more with P
  Eigen::MatrixXd rigidity, flexibility;  ///< [N/m], [m/N], of the strains
  Eigen::MatrixXd mass;                   ///< [kg], of the coordinates
};

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// @param direction t, of length 1.
/// @param section with an axial stiffness; @param axial_load P [N], positive in compression
FrameElementMatrices frame_element_matrices(const Section& section, const Mesh::Element& element,
                                            const Eigen::Vector2d& direction, double axial_load,
                                            MassModel mass_model) {
  const ElementMatrices bending = element_matrices(section, element, 0.0, axial_load, mass_model);
  const RodMatrices rod =
      rod_matrices(section, element, *section.axial_stiffness, section.mass_per_length, mass_model);
  const Index bent_inside = bending.interior ? 2 : 0, inside = bent_inside + rod.inside(),
              strains = 3 + inside, coordinates = 6 + inside;
  const Eigen::Vector2d& t = direction;
  const Eigen::Vector2d n(-t[1], t[0]);

  FrameElementMatrices result;
  result.strain = MatrixXd::Zero(strains, coordinates);
  result.strain.topLeftCorner<3, 6>() << -1, 0, -n[0], 1, 0, 0,  //
      0, -1, -n[1], 0, 1, 0,                                     //
      0, 0, -1, 0, 0, 1;
  result.strain.bottomRightCorner(inside, inside).setIdentity();

  // (elongation, epsilon_1, epsilon_2, interior) -> the strains here, an orthogonal matrix
  MatrixXd turn = MatrixXd::Identity(strains, strains);
  turn.topLeftCorner<2, 2>() << t, -n;
  const auto turned = [&](const VectorXd& stretch, const MatrixXd& bend) {
    MatrixXd block = MatrixXd::Zero(strains, strains);
    block(0, 0) = stretch[0];
    block.block(1, 1, bend.rows(), bend.rows()) = bend;
    block.diagonal().tail(rod.inside()) = stretch.tail(rod.inside());
    return MatrixXd(turn * block * turn.transpose());
  };
  const bool deep = bent_inside > 0;
  result.rigidity =
      turned(rod.rigidity, deep ? MatrixXd(bending.interior->rigidity) : MatrixXd(bending.rigidity));
  result.flexibility =
      turned(rod.flexibility, deep ? MatrixXd(bending.interior->flexibility) : MatrixXd(bending.flexibility));
  if (axial_load != 0.0)
    add_chord(n, 3, axial_load / element.length, result.strain, result.rigidity, result.flexibility);

  MatrixXd across =
      MatrixXd::Zero(4 + bent_inside, coordinates);  // (w_1, h theta_1, w_2, h theta_2, interior)
  across.block<1, 2>(0, 0) = across.block<1, 2>(2, 3) = n.transpose();
  across(1, 2) = across(3, 5) = 1.0;
  across.block(4, 6, bent_inside, bent_inside).setIdentity();
  MatrixXd along = MatrixXd::Zero(2 + rod.inside(), coordinates);  // (u_1, u_2, interior)
  along.block<1, 2>(0, 0) = along.block<1, 2>(1, 3) = t.transpose();
  along.bottomRightCorner(rod.inside(), rod.inside()).setIdentity();
  const MatrixXd mass = deep ? MatrixXd(bending.interior->mass) : MatrixXd(bending.mass);
  result.mass = across.transpose() * mass * across + along.transpose() * rod.mass * along;
  return result;
}

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
    for (const Frame::Body& body : frame_.bodies) {
      const NodeCoordinates& node = nodes_[body.joint];
      equations_.add_mass(node.u, node.u, body.mass, 0);
      equations_.add_mass(node.v, node.v, body.mass, 1);
      equations_.add_mass(node.turn.coordinate, node.turn.coordinate,
                          body.rotary_inertia / (node.turn.scale * node.turn.scale), -1);
    }
    for (const Frame::Dashpot& dashpot : frame_.dashpots) {
      const NodeCoordinates& node = nodes_[dashpot.joint];
      equations_.add_damping(node.u, dashpot.x);
      equations_.add_damping(node.v, dashpot.y);
      equations_.add_damping(node.turn.coordinate, dashpot.rotational / (node.turn.scale * node.turn.scale));
    }
    check_points(system_, points, frame_.joints.size());
    for (const FramePoint& point : points)
      equations_.add_point(point.name, {nodes_[point.joint].u, nodes_[point.joint].v});
    equations_.put_into(system_);
    return std::move(system_);
  }

 private:
  const Frame& frame_;
  const int elements_;
  StructuralSystem system_;
  std::vector<NodeCoordinates> nodes_;
  std::vector<Frame::Support> held_;
  std::vector<int> rigid_joints_;  // those whose rotation some member shares
  FrameEquations equations_{"xy"};

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
      const auto inside = static_cast<int>(system_.coordinates.size());
      for (Eigen::Index i = 6; i < matrices.strain.cols(); ++i) add_coordinate(Kind::generalised, node, 1.0);
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
    const double h = element.length;
    const auto strains = static_cast<int>(matrices.strain.rows());
    const auto coordinates = static_cast<int>(matrices.strain.cols());
    std::vector<int> at{one.u, one.v, first.coordinate, two.u, two.v, second.coordinate};
    std::vector<double> ratio{1, 1, h / first.scale, 1, 1, h / second.scale};  // h theta per coordinate
    for (int i = 6; i < coordinates; ++i) at.push_back(inside + i - 6), ratio.push_back(1.0);
    for (int i = 0; i < coordinates; ++i)
      for (int j = 0; j < coordinates; ++j)
        equations_.add_mass(at[i], at[j], ratio[i] * matrices.mass(i, j) * ratio[j],
                            j < 6 && j % 3 < 2 ? j % 3 : -1);
    for (int row = 0; row < strains; ++row)
      for (int j = 0; j < coordinates; ++j)
        equations_.add_strain(equations_.strains() + row, at[j], matrices.strain(row, j) * ratio[j]);
    equations_.add_rigidity(matrices.rigidity, matrices.flexibility);
  }

  void add_springs(int joint) {
    const NodeCoordinates& node = nodes_[joint];
    for (const Frame::Spring& spring : frame_.springs) {
      if (spring.joint != joint) continue;
      equations_.add_ground_spring(node.u, spring.x);
      equations_.add_ground_spring(node.v, spring.y);
      equations_.add_ground_spring(node.turn.coordinate,
                                   spring.rotational / (node.turn.scale * node.turn.scale));
    }
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
