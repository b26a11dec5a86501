#include "fem/frame.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "fem/frame_graph.hpp"

namespace beamid::fem {
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
