#include "fem/frame.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>

namespace beamid::fem {
namespace {

std::vector<std::vector<std::size_t>> members_of_joints(std::size_t joints,
                                                        const std::vector<MemberEnds>& members) {
  std::vector<std::vector<std::size_t>> result(joints);
  for (std::size_t i = 0; i < members.size(); ++i)
    for (const int joint : {members[i].first, members[i].second})
      result[static_cast<std::size_t>(joint)].push_back(i);
  return result;
}

}  // namespace

std::vector<FrameStep> walk(const std::vector<int>& held, const std::vector<MemberEnds>& members) {
  const std::size_t count = held.size();
  std::vector<int> starts(count);
  std::iota(starts.begin(), starts.end(), 0);
  std::stable_sort(starts.begin(), starts.end(), [&](int a, int b) { return held[a] > held[b]; });
  const auto of_joint = members_of_joints(count, members);
  std::vector<FrameStep> steps;
  std::vector<bool> reached(count, false), taken(members.size(), false);
  for (const int start : starts) {
    if (reached[start]) continue;
    reached[start] = true;
    std::deque<int> waiting{start};
    while (!waiting.empty()) {
      const int from = waiting.front();
      waiting.pop_front();
      for (const std::size_t i : of_joint[from]) {
        if (taken[i]) continue;
        taken[i] = true;
        const bool reversed = members[i].second == from;
        const int to = reversed ? members[i].first : members[i].second;
        steps.push_back({i, from, to, reversed});
        if (!reached[to]) waiting.push_back(to);
        reached[to] = true;
      }
    }
  }
  return steps;
}

int first_joint_apart(int joints, const std::vector<MemberEnds>& members) {
  std::vector<bool> reached(static_cast<std::size_t>(joints), false);
  const auto of_joint = members_of_joints(reached.size(), members);
  std::vector<int> waiting{0};
  reached[0] = true;
  while (!waiting.empty()) {
    const int from = waiting.back();
    waiting.pop_back();
    for (const std::size_t i : of_joint[from])
      for (const int to : {members[i].first, members[i].second})
        if (!reached[to]) reached[to] = true, waiting.push_back(to);
  }
  const auto apart = std::find(reached.begin(), reached.end(), false);
  return apart == reached.end() ? -1 : static_cast<int>(apart - reached.begin());
}

void refuse_in_frame(const std::string& what, double value, const std::string& expected) {
  std::ostringstream message;
  message << what << " is " << value << "; expected " << expected;
  throw std::invalid_argument(message.str());
}

void check_in_frame(const std::string& what, double value, bool positive_only, const std::string& unit) {
  if (!std::isfinite(value) || (positive_only && value < 0.0))
    refuse_in_frame(what, value,
                    (positive_only ? "zero or a positive number of " : "a finite number of ") + unit);
}

void check_joint_in_frame(const std::string& what, int joint, int joints) {
  if (joint < 0 || joint >= joints)
    refuse_in_frame("joint of " + what, joint, "one of the frame's, 0 to " + std::to_string(joints - 1));
}

void check_frame_graph(int joints, const std::vector<MemberEnds>& members) {
  if (members.empty()) throw std::invalid_argument("the frame has no member; expected at least one");
  std::vector<bool> used(static_cast<std::size_t>(joints), false);
  for (std::size_t i = 0; i < members.size(); ++i)
    for (const int joint : {members[i].first, members[i].second}) {
      check_joint_in_frame("member " + std::to_string(i), joint, joints);
      used[joint] = true;
    }
  for (int joint = 0; joint < joints; ++joint)
    if (!used[joint])
      throw std::invalid_argument("joint " + std::to_string(joint) + " has no member; expected at least one");
  if (const int apart = first_joint_apart(joints, members); apart >= 0)
    throw std::invalid_argument("joint " + std::to_string(apart) +
                                " is not connected with joint 0; expected members between all parts");
}

namespace {

void check_member(const Frame& frame, std::size_t i) {
  const Frame::Member& member = frame.members[i];
  const std::string name = "member " + std::to_string(i);
  if (frame.length(i) == 0.0)
    throw std::invalid_argument(name + " has no length; expected joints at different places");
  if (!member.section.axial_stiffness)
    throw std::invalid_argument(name + " has no axial stiffness; expected E A [N], which a frame needs");
  if (!(member.stiffness_factor > 0.0 && std::isfinite(member.stiffness_factor)))
    refuse_in_frame("stiffness factor of " + name, member.stiffness_factor, "a positive number");
  check_in_frame("axial load of " + name, member.axial_load, false, "N");
  Beam beam;
  beam.segments = {{frame.length(i), member.section}};
  try {
    validate(beam);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(name + ": " + error.what());
  }
}

}  // namespace

double Frame::length(std::size_t member) const {
  const Joint &first = joints[members[member].first], &second = joints[members[member].second];
  return std::hypot(second.x - first.x, second.y - first.y);
}

void validate(const Frame& frame) {
  const auto count = static_cast<int>(frame.joints.size());
  for (int joint = 0; joint < count; ++joint) {
    check_in_frame("x of joint " + std::to_string(joint), frame.joints[joint].x, false, "metres");
    check_in_frame("y of joint " + std::to_string(joint), frame.joints[joint].y, false, "metres");
  }
  for (std::size_t i = 0; i < frame.members.size(); ++i) {
    for (const int joint : {frame.members[i].first, frame.members[i].second})
      check_joint_in_frame("member " + std::to_string(i), joint, count);
    check_member(frame, i);
  }
  check_frame_graph(count, member_ends(frame));
  for (const Frame::Support& support : frame.supports)
    check_joint_in_frame("a support", support.joint, count);
  for (const Frame::Body& body : frame.bodies) {
    check_joint_in_frame("a body", body.joint, count);
    check_in_frame("body mass", body.mass, true, "kg");
    check_in_frame("body rotary inertia", body.rotary_inertia, true, "kg m2");
  }
  for (const Frame::Spring& spring : frame.springs) {
    check_joint_in_frame("a spring", spring.joint, count);
    check_in_frame("spring stiffness along x", spring.x, true, "N/m");
    check_in_frame("spring stiffness along y", spring.y, true, "N/m");
    check_in_frame("rotational spring stiffness", spring.rotational, true, "N m/rad");
  }
  for (const Frame::Dashpot& dashpot : frame.dashpots) {
    check_joint_in_frame("a dashpot", dashpot.joint, count);
    check_in_frame("damping along x", dashpot.x, true, "N s/m");
    check_in_frame("damping along y", dashpot.y, true, "N s/m");
    check_in_frame("rotational damping", dashpot.rotational, true, "N m s/rad");
  }
}

}  // namespace beamid::fem
