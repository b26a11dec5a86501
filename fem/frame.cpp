#include "fem/frame.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace beamid::fem {
namespace {

[[noreturn]] void refuse(const std::string& what, double value, const std::string& expected) {
  std::ostringstream message;
  message << what << " is " << value << "; expected " << expected;
  throw std::invalid_argument(message.str());
}

void check_member(const Frame& frame, std::size_t i) {
  const Frame::Member& member = frame.members[i];
  const std::string name = "member " + std::to_string(i);
  if (frame.length(i) == 0.0)
    throw std::invalid_argument(name + " has no length; expected joints at different places");
  if (!member.section.axial_stiffness)
    throw std::invalid_argument(name + " has no axial stiffness; expected E A [N], which a frame needs");
  if (!(member.stiffness_factor > 0.0 && std::isfinite(member.stiffness_factor)))
    refuse("stiffness factor of " + name, member.stiffness_factor, "a positive number");
  Beam beam;
  beam.segments = {{frame.length(i), member.section}};
  try {
    validate(beam);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(name + ": " + error.what());
  }
}

}  // namespace

int first_joint_apart(const Frame& frame) {
  std::vector<bool> reached(frame.joints.size(), false);
  reached[0] = true;
  for (bool more = true; more;) {
    more = false;
    for (const Frame::Member& member : frame.members)
      if (reached[member.first] != reached[member.second])
        reached[member.first] = reached[member.second] = more = true;
  }
  const auto apart = std::find(reached.begin(), reached.end(), false);
  return apart == reached.end() ? -1 : static_cast<int>(apart - reached.begin());
}

double Frame::length(std::size_t member) const {
  const Joint &first = joints[members[member].first], &second = joints[members[member].second];
  return std::hypot(second.x - first.x, second.y - first.y);
}

void validate(const Frame& frame) {
  if (frame.members.empty()) throw std::invalid_argument("the frame has no member; expected at least one");
  const auto count = static_cast<int>(frame.joints.size());
  const auto check_joint = [&](const std::string& what, int joint) {
    if (joint < 0 || joint >= count)
      refuse("joint of " + what, joint, "one of the frame's, 0 to " + std::to_string(count - 1));
  };
  const auto check_number = [&](const std::string& what, double value, bool signed_value,
                                const std::string& unit) {
    if (!std::isfinite(value) || (!signed_value && value < 0.0))
      refuse(what, value, (signed_value ? "a finite number of " : "zero or a positive number of ") + unit);
  };
  for (int joint = 0; joint < count; ++joint) {
    check_number("x of joint " + std::to_string(joint), frame.joints[joint].x, true, "metres");
    check_number("y of joint " + std::to_string(joint), frame.joints[joint].y, true, "metres");
  }
  std::vector<bool> used(frame.joints.size(), false);
  for (std::size_t i = 0; i < frame.members.size(); ++i) {
    for (const int joint : {frame.members[i].first, frame.members[i].second}) {
      check_joint("member " + std::to_string(i), joint);
      used[joint] = true;
    }
    check_member(frame, i);
  }
  for (int joint = 0; joint < count; ++joint)
    if (!used[joint])
      throw std::invalid_argument("joint " + std::to_string(joint) + " has no member; expected at least one");
  if (const int apart = first_joint_apart(frame); apart >= 0)
    throw std::invalid_argument("joint " + std::to_string(apart) +
                                " is not connected with joint 0; expected members between all parts");
  for (const Frame::Support& support : frame.supports) check_joint("a support", support.joint);
  for (const Frame::Body& body : frame.bodies) {
    check_joint("a body", body.joint);
    check_number("body mass", body.mass, false, "kg");
    check_number("body rotary inertia", body.rotary_inertia, false, "kg m2");
  }
  for (const Frame::Spring& spring : frame.springs) {
    check_joint("a spring", spring.joint);
    check_number("spring stiffness along x", spring.x, false, "N/m");
    check_number("spring stiffness along y", spring.y, false, "N/m");
    check_number("rotational spring stiffness", spring.rotational, false, "N m/rad");
  }
}

}  // namespace beamid::fem
