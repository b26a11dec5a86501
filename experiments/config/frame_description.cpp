#include "experiments/config/frame_description.hpp"

#include <fmt/format.h>

#include "experiments/config/frame_text.hpp"

namespace beamid::experiments {
namespace {

std::string joint_name(const fem::Frame& frame, int joint) {
  const std::string& name = frame.joints[static_cast<std::size_t>(joint)].name;
  return name.empty() ? fmt::format("{}", joint + 1) : name;
}

}  // namespace

const std::vector<std::pair<std::string, fem::Frame::Support>>& frame_support_kinds() {
  static const std::vector<std::pair<std::string, fem::Frame::Support>> kinds{
      {"clamped", {0, true, true, true}},     {"pinned", {0, true, true, false}},
      {"rolling_x", {0, false, true, false}}, {"rolling_y", {0, true, false, false}},
      {"sliding_x", {0, false, true, true}},  {"sliding_y", {0, true, false, true}},
      {"guided", {0, false, false, true}}};
  return kinds;
}

std::string frame_support_kind(const fem::Frame::Support& support) {
  for (const auto& [name, kind] : frame_support_kinds())
    if (kind.x == support.x && kind.y == support.y && kind.rotation == support.rotation) return name;
  return "free";
}

std::string frame_text(const fem::Frame& frame, int elements_per_member, Eigen::Index coordinates) {
  std::string text =
      fmt::format("Plane frame: {} between {}, {:.6g} kg", counted(frame.members.size(), "member"),
                  counted(frame.joints.size(), "joint"), total_mass(frame));
  std::string held;
  for (const auto& [name, kind] : frame_support_kinds()) {
    std::string joints;
    for (const fem::Frame::Support& support : frame.supports)
      if (frame_support_kind(support) == name)
        joints += (joints.empty() ? "" : ", ") + joint_name(frame, support.joint);
    if (!joints.empty()) held += fmt::format("; {} at {}", name, joints);
  }
  text += held.empty() ? "; nowhere held" : held;
  return text + attachments_text(frame) + mesh_text(frame, elements_per_member, coordinates);
}

double total_mass(const fem::Frame& frame) {
  double sum = 0.0;
  for (std::size_t i = 0; i < frame.members.size(); ++i)
    sum += frame.members[i].section.mass_per_length.mean() * frame.length(i);
  for (const fem::Frame::Body& body : frame.bodies) sum += body.mass;
  return sum;
}

}  // namespace beamid::experiments
