#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "fem/elements/space_frame_element.hpp"
#include "fem/frame.hpp"
#include "fem/frame_equations.hpp"
#include "fem/space_frame.hpp"

namespace beamid::fem {
namespace {

// Which rotations of members' ends are free of their joints.

/// Directions in which a member's end turns without its joint, of length 1 and across each other, as columns
/// (3 x 0 to 3).
using ReleasedDirections = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;

using Eigen::Matrix3d, Eigen::Vector3d;

constexpr double no_direction = 1e-9;  // squared sine of the angle between two directions that are one

ReleasedDirections released_axes(const SpaceFrame::End& end, const Matrix3d& axes) {
  ReleasedDirections directions(3, int{end.x} + int{end.y} + int{end.z});
  int column = 0;
  for (const auto& [released, axis] : {std::pair{end.x, 0}, {end.y, 1}, {end.z, 2}})
    if (released) directions.col(column++) = axes.col(axis);
  return directions;
}

// The directions within `from` that are across all of `without`.
ReleasedDirections across(const ReleasedDirections& from, const ReleasedDirections& without) {
  const Matrix3d kept = from * from.transpose() - without * without.transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(kept);
  return solver.eigenvectors().rightCols(from.cols() - without.cols());
}

/// Of each member at its first and at its second end. Where a direction is free of all members of a joint and
/// no support holds it, nothing would turn the joint: the first of these members keeps it.
std::vector<std::array<ReleasedDirections, 2>> released_ends(const SpaceFrame& frame) {
  const std::size_t count = frame.joints.size();
  std::vector<std::array<ReleasedDirections, 2>> released(frame.members.size());
  std::vector<Matrix3d> turned(count, Matrix3d::Zero());  // sums of the directions in which a joint is turned
  std::vector<ReleasedDirections*> first(count, nullptr);
  for (std::size_t i = 0; i < frame.members.size(); ++i) {
    const SpaceFrame::Member& member = frame.members[i];
    const Matrix3d axes = frame.axes(i);
    released[i] = {released_axes(member.at_first, axes), released_axes(member.at_second, axes)};
    for (const auto& [joint, end] : {std::pair{member.first, 0}, {member.second, 1}}) {
      ReleasedDirections& own = released[i][static_cast<std::size_t>(end)];
      turned[static_cast<std::size_t>(joint)] += Matrix3d::Identity() - own * own.transpose();
      if (first[static_cast<std::size_t>(joint)] == nullptr) first[static_cast<std::size_t>(joint)] = &own;
    }
  }
  for (const SpaceFrame::Support& support : frame.supports)
    for (const auto& [held, axis] : {std::pair{support.rx, 0}, {support.ry, 1}, {support.rz, 2}})
      if (held) turned[static_cast<std::size_t>(support.joint)](axis, axis) += 1.0;
  for (std::size_t joint = 0; joint < count; ++joint) {
    if (first[joint] == nullptr || first[joint]->cols() == 0) continue;
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(turned[joint]);
    const Eigen::Index idle = (solver.eigenvalues().array() < no_direction).count();
    if (idle > 0) *first[joint] = across(*first[joint], solver.eigenvectors().leftCols(idle));
  }
  return released;
}

using Kind = Coordinate::Kind;

constexpr std::array displacement_kinds{Kind::axial, Kind::deflection, Kind::lateral};
constexpr std::array rotation_kinds{Kind::rotation_x, Kind::rotation_y, Kind::rotation};

// A motion as a sum of coordinates; empty: held.
struct Term {
  int coordinate;
  double factor;
};
using Terms = std::vector<Term>;

void add_term(Terms& terms, int coordinate, double factor) {
  if (coordinate >= 0 && factor != 0.0) terms.push_back({coordinate, factor});
}

struct SpaceNode {
  std::array<int, 3> displacement{-1, -1, -1}, rotation{-1, -1, -1};  // -1: held
  double scale = 1.0;                                                 // of the rotations
  bool known = false;
};

// Displacements d and rotations h theta of one end of an element, or of a point rigidly fixed to a joint.
struct SpaceMotion {
  std::array<Terms, 3> displacement, rotation;
};

// At `arm` from the node, rotations times `length`.
SpaceMotion motion_at(const SpaceNode& node, const Vector3d& arm, double length) {
  SpaceMotion motion;
  for (int i = 0; i < 3; ++i) {
    add_term(motion.displacement[i], node.displacement[i], 1.0);
    add_term(motion.rotation[i], node.rotation[i], length / node.scale);
    const Vector3d swing = Vector3d::Unit(i).cross(arm);  // of a rotation of 1 about axis i
    for (int j = 0; j < 3; ++j) add_term(motion.displacement[j], node.rotation[i], swing[j] / node.scale);
  }
  return motion;
}

SpaceSection stiffened(const SpaceFrame::Member& member) {
  SpaceSection section = member.section;
  for (double* const stiffness : {&section.axial_stiffness, &section.bending_stiffness_y,
                                  &section.bending_stiffness_z, &section.torsional_stiffness})
    *stiffness *= member.stiffness_factor;
  for (std::optional<double>* const stiffness : {&section.shear_stiffness_y, &section.shear_stiffness_z})
    if (*stiffness) **stiffness *= member.stiffness_factor;
  return section;
}

class SpaceFrameAssembly {
 public:
  SpaceFrameAssembly(const SpaceFrame& frame, int elements)
      : frame_(frame), elements_(elements), released_(released_ends(frame)) {
    system_.mesh.spatial = true;
    for (const SpaceFrame::Joint& joint : frame.joints) add_mesh_node(joint.place);
    held_.resize(frame.joints.size(), free());
    for (const SpaceFrame::Support& support : frame.supports) {
      SpaceFrame::Support& all = held_[support.joint];
      all.x |= support.x, all.y |= support.y, all.z |= support.z;
      all.rx |= support.rx, all.ry |= support.ry, all.rz |= support.rz;
    }
    springs_.resize(frame.joints.size());
    for (const SpaceFrame::Spring& spring : frame.springs) springs_[spring.joint].push_back(&spring);
  }

  StructuralSystem finish(const std::vector<SpaceFramePoint>& points) {
    std::vector<int> held;
    for (const SpaceFrame::Support& s : held_)
      held.push_back(int{s.x} + int{s.y} + int{s.z} + int{s.rx} + int{s.ry} + int{s.rz});
    for (const FrameStep& step : walk(held, member_ends(frame_))) add_member(step);
    for (const SpaceFrame::Body& body : frame_.bodies) add_body(body);
    for (const SpaceFrame::Dashpot& dashpot : frame_.dashpots) {
      const SpaceNode& node = nodes_[dashpot.joint];
      for (int i = 0; i < 3; ++i) {
        equations_.add_damping(node.displacement[i], dashpot.translational[i]);
        equations_.add_damping(node.rotation[i], dashpot.rotational[i] / (node.scale * node.scale));
      }
    }
    check_points(system_, points, frame_.joints.size());
    for (const SpaceFramePoint& point : points) {
      const std::array<int, 3>& at = nodes_[point.joint].displacement;
      equations_.add_point(point.name, {at.begin(), at.end()});
    }
    equations_.put_into(system_);
    return std::move(system_);
  }

 private:
  const SpaceFrame& frame_;
  const int elements_;
  const std::vector<std::array<ReleasedDirections, 2>> released_;
  StructuralSystem system_;
  std::vector<SpaceNode> nodes_;
  std::vector<SpaceFrame::Support> held_;
  std::vector<std::vector<const SpaceFrame::Spring*>> springs_;  // of each joint
  FrameEquations equations_{"xyz"};

  static SpaceFrame::Support free() { return {0, false, false, false, false, false, false}; }

  int add_mesh_node(const Vector3d& place) {
    system_.mesh.nodes.push_back({place.x(), place.y(), place.z()});
    nodes_.emplace_back();
    return static_cast<int>(nodes_.size()) - 1;
  }

  int add_coordinate(Kind kind, int node, double scale) {
    const bool nodal = kind != Kind::generalised;
    system_.coordinates.push_back({kind, system_.mesh.nodes[node].x, scale, nodal ? node : -1});
    return static_cast<int>(system_.coordinates.size()) - 1;
  }

  void know(int node, double scale, const SpaceFrame::Support& held) {
    SpaceNode& known = nodes_[node];
    known.known = true;
    known.scale = scale;
    const std::array displacement_held{held.x, held.y, held.z}, rotation_held{held.rx, held.ry, held.rz};
    for (int i = 0; i < 3; ++i)
      if (!displacement_held[i]) known.displacement[i] = add_coordinate(displacement_kinds[i], node, 1.0);
    for (int i = 0; i < 3; ++i)
      if (!rotation_held[i]) known.rotation[i] = add_coordinate(rotation_kinds[i], node, scale);
  }

  // Of a member's end: beyond its offset, and turned against its joint where moments do not pass.
  SpaceMotion end_motion(std::size_t member, bool at_second, double length) {
    const SpaceFrame::Member& of = frame_.members[member];
    const int joint = at_second ? of.second : of.first;
    SpaceMotion motion =
        motion_at(nodes_[joint], at_second ? of.at_second.offset : of.at_first.offset, length);
    const ReleasedDirections& released = released_[member][at_second ? 1 : 0];
    for (Eigen::Index k = 0; k < released.cols(); ++k) {
      const int turn = add_coordinate(Kind::generalised, joint, length);
      for (int i = 0; i < 3; ++i) add_term(motion.rotation[i], turn, released(i, k));
    }
    return motion;
  }

  void add_member(const FrameStep& step) {
    const Vector3d begin = step.reversed ? frame_.end(step.member) : frame_.begin(step.member),
                   end = step.reversed ? frame_.begin(step.member) : frame_.end(step.member);
    Mesh::Element element;
    element.segment = static_cast<int>(step.member);
    element.length = frame_.length(step.member) / elements_;
    if (!nodes_[step.from].known) {
      know(step.from, element.length, held_[step.from]);
      add_springs(step.from);
    }
    Matrix3d axes = frame_.axes(step.member);
    if (step.reversed) axes.leftCols<2>() *= -1.0;
    const SpaceFrameElementMatrices matrices =
        space_frame_element_matrices(stiffened(frame_.members[step.member]), element, axes,
                                     frame_.members[step.member].axial_load, frame_.mass_model);
    const auto inside = static_cast<int>(matrices.strain.cols()) - 12;
    element.first = step.from;
    SpaceMotion motion = end_motion(step.member, step.reversed, element.length);
    for (int e = 0; e < elements_; ++e) {
      const auto place = [&](int i) {
        const double s = static_cast<double>(i) / elements_;
        return step.reversed ? 1.0 - s : s;
      };
      const bool last = e + 1 == elements_;
      element.from = place(e), element.to = place(e + 1);
      element.second = last ? step.to : add_mesh_node(begin + (e + 1.0) / elements_ * (end - begin));
      const int first_inside = static_cast<int>(system_.coordinates.size());
      for (int i = 0; i < inside; ++i) add_coordinate(Kind::generalised, element.first, 1.0);
      const bool reaches = !nodes_[element.second].known;
      if (reaches) know(element.second, element.length, last ? held_[step.to] : free());
      const SpaceMotion next = last ? end_motion(step.member, !step.reversed, element.length)
                                    : motion_at(nodes_[element.second], Vector3d::Zero(), element.length);
      add_element(element, matrices, motion, next, first_inside);
      if (reaches && last) add_springs(step.to);
      element.first = element.second;
      motion = next;
    }
  }

  void add_element(const Mesh::Element& element, const SpaceFrameElementMatrices& matrices,
                   const SpaceMotion& first, const SpaceMotion& second, int first_inside) {
    system_.mesh.elements.push_back(element);
    std::vector<Terms> motions;
    for (const SpaceMotion* const end : {&first, &second}) {
      motions.insert(motions.end(), end->displacement.begin(), end->displacement.end());
      motions.insert(motions.end(), end->rotation.begin(), end->rotation.end());
    }
    const auto count = static_cast<int>(matrices.strain.cols()),
               strains = static_cast<int>(matrices.strain.rows());
    for (int i = 12; i < count; ++i) motions.push_back({{first_inside + i - 12, 1.0}});
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j) {
        const double entry = matrices.mass(i, j);
        if (entry == 0.0) continue;
        const int direction = j < 12 && j % 6 < 3 ? j % 6 : -1;  // of the base's motion that moves j
        add_mass(motions[i], motions[j], entry, direction);
      }
    for (int row = 0; row < strains; ++row)
      for (int j = 0; j < count; ++j)
        for (const Term& term : motions[j])
          equations_.add_strain(equations_.strains() + row, term.coordinate,
                                matrices.strain(row, j) * term.factor);
    equations_.add_rigidity(matrices.rigidity, matrices.flexibility);
  }

  // @param direction of the base's motion by which `column` moves; -1: none
  void add_mass(const Terms& row, const Terms& column, double value, int direction) {
    for (const Term& a : row) {
      for (const Term& b : column)
        equations_.add_mass(a.coordinate, b.coordinate, a.factor * value * b.factor, -1);
      equations_.add_mass(a.coordinate, -1, a.factor * value, direction);
    }
  }

  void add_body(const SpaceFrame::Body& body) {
    const SpaceMotion centre = motion_at(nodes_[body.joint], body.offset, 1.0);
    for (int i = 0; i < 3; ++i) {
      if (body.mass > 0.0) add_mass(centre.displacement[i], centre.displacement[i], body.mass, i);
      if (body.inertia[i] > 0.0) add_mass(centre.rotation[i], centre.rotation[i], body.inertia[i], -1);
    }
  }

  void add_springs(int joint) {
    const SpaceNode& node = nodes_[joint];
    for (const SpaceFrame::Spring* const spring : springs_[joint])
      for (int i = 0; i < 3; ++i) {
        equations_.add_ground_spring(node.displacement[i], spring->translational[i]);
        equations_.add_ground_spring(node.rotation[i], spring->rotational[i] / (node.scale * node.scale));
      }
  }
};

}  // namespace

StructuralSystem assemble(const SpaceFrame& frame, int elements_per_member,
                          const std::vector<SpaceFramePoint>& points) {
  validate(frame);
  if (elements_per_member < 1)
    throw std::invalid_argument("elements per member is " + std::to_string(elements_per_member) +
                                "; expected at least 1");
  return SpaceFrameAssembly(frame, elements_per_member).finish(points);
}

}  // namespace beamid::fem
