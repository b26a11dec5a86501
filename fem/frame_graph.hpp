// How the members of a frame, plane or in space, hang together, and what all kinds of frames check.
#pragma once

#include <string>
#include <vector>

namespace beamid::fem {

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

}  // namespace beamid::fem
