// A plane frame: straight members between joints, in SI units.
#pragma once

#include <string>
#include <vector>

#include "fem/beam.hpp"
#include "fem/structural_system.hpp"

namespace beamid::fem {

// How the members of a frame, plane or in space, hang together, and what all kinds of frames check.

/// The joints, from 0 on, between which a member goes.
struct MemberEnds {
  int first = 0, second = 0;
};

template <class AnyFrame>
std::vector<MemberEnds> member_ends(const AnyFrame& frame) {
  std::vector<MemberEnds> ends;
  for (const auto& member : frame.members) ends.push_back({member.first, member.second});
  return ends;
}

/// The first joint that no chain of members connects with joint 0; -1: all are in one piece.
int first_joint_apart(int joints, const std::vector<MemberEnds>& members);

/// One member on the way, from a joint that is known to another.
struct FrameStep {
  std::size_t member = 0;
  int from = 0, to = 0;   ///< joints
  bool reversed = false;  ///< from its second joint to its first
};

/// All members, each once, breadth first: each step starts at a joint that an earlier one reached, or at the
/// start of a part of the frame that is not connected to the earlier ones. It starts where most is held.
/// @param held how many motions of each joint supports hold
std::vector<FrameStep> walk(const std::vector<int>& held, const std::vector<MemberEnds>& members);

/// @throws std::invalid_argument "WHAT is VALUE; expected EXPECTED"
[[noreturn]] void refuse_in_frame(const std::string& what, double value, const std::string& expected);

/// @throws std::invalid_argument unless the number is finite and, if `positive_only`, not negative.
void check_in_frame(const std::string& what, double value, bool positive_only, const std::string& unit);

/// @throws std::invalid_argument unless there is such a joint.
void check_joint_in_frame(const std::string& what, int joint, int joints);

/// @throws std::invalid_argument where there is no member, one ends at no joint, a joint has none, or the
/// members are not in one piece.
void check_frame_graph(int joints, const std::vector<MemberEnds>& members);

/// A frame in the plane of x and y, moving in that plane. Joints are told by their number, from 0 on.
struct Frame {
  struct Joint {
    double x = 0.0, y = 0.0;  ///< [m]
    std::string name = {};    ///< empty: its number, from 1
  };
  /// Between two joints, rigidly fixed to them but for hinges, through which no moment passes. The section
  /// varies from the first joint to the second and needs an axial stiffness.
  struct Member {
    int first = 0, second = 0;
    Section section;
    bool hinged_at_first = false, hinged_at_second = false;
    double stiffness_factor = 1.0;  ///< of E I, E A and kappa G A: damage, or what a group is found to have
    std::string group = {};         ///< whose members share an unknown factor; empty: none
    double axial_load = 0.0;        ///< P [N], positive in compression, along the member as it stands at rest
  };
  /// What is held at zero: clamped as it stands, pinned without the rotation, rolling without x or y too.
  struct Support {
    int joint = 0;
    bool x = true, y = true, rotation = true;
  };
  struct Body {
    int joint = 0;
    double mass = 0.0;            ///< [kg]
    double rotary_inertia = 0.0;  ///< [kg m2]
  };
  /// Between a joint and the ground.
  struct Spring {
    int joint = 0;
    double x = 0.0, y = 0.0;  ///< [N/m]
    double rotational = 0.0;  ///< [N m/rad]
  };
  /// Likewise, of the velocities.
  struct Dashpot {
    int joint = 0;
    double x = 0.0, y = 0.0;  ///< [N s/m]
    double rotational = 0.0;  ///< [N m s/rad]
  };
  std::vector<Joint> joints;
  std::vector<Member> members;
  std::vector<Support> supports;
  std::vector<Body> bodies;
  std::vector<Spring> springs;
  std::vector<Dashpot> dashpots = {};
  MassModel mass_model = MassModel::consistent;
  char base_axis = 'x';  ///< along which the base moves, 'x' or 'y'

  double length(std::size_t member) const;  ///< [m]
};

/// @throws std::invalid_argument naming the first joint, member or quantity that is impossible.
void validate(const Frame& frame);

/// A joint where forces act and motion is observed.
struct FramePoint {
  std::string name;
  int joint = 0;
};

/// Finite elements: each member is cut into `elements_per_member` equal ones, which bend as those of a beam
/// do (elements/element.hpp) and stretch as rods do (elements/rod_element.hpp), the elongation being a third
/// strain of rigidity EA/h; frequencies err by h^4, by h^2 with lumped mass.
///
/// Coordinates of a node: u and v [m], its displacements along x (Coordinate::Kind::axial) and y
/// (deflection), and the scaled rotation s theta [m], counterclockwise. The mesh's first nodes are the
/// frame's joints. Where a hinge lets a member turn against its joint the end's rotation is a coordinate of
/// its own (generalised, as the interior ones of elements are); at a joint where all members are hinged one
/// of them turns with the joint.
///
/// The strains of an element from node 1 to node 2 in the direction t, n being t turned by 90 degrees, are
/// written along x and y,
///
///     (u_2, v_2) - (u_1, v_1) - n h theta_1 = t elongation - n epsilon_1,
///     h theta_2 - h theta_1 = epsilon_2,
///
/// and elements come in the order of a walk over the frame, so that each of these determines one coordinate;
/// where the walk closes a loop or meets a support they are redundant.
///
/// Each point is, for each of x and y in which it can move, an input NAME_force_x [N] and an output
/// NAME_displacement_x [m]. The last two inputs are base_acceleration_x and base_acceleration_y [m/s2], of
/// all supports and springs.
///
/// @throws std::invalid_argument when the frame is impossible, elements_per_member < 1, or a point does not
/// exist or cannot move.
StructuralSystem assemble(const Frame& frame, int elements_per_member,
                          const std::vector<FramePoint>& points = {});

}  // namespace beamid::fem
