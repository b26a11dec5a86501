#include "experiments/config/space_frame_description.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/config/frame_text.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;
using fem::SpaceFrame;

std::vector<double> numbers_of(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

std::vector<std::string> held_by(const SpaceFrame::Support& s) {
  std::vector<std::string> held;
  for (const auto& [holds, motion] :
       {std::pair{s.x, "x"}, {s.y, "y"}, {s.z, "z"}, {s.rx, "rx"}, {s.ry, "ry"}, {s.rz, "rz"}})
    if (holds) held.emplace_back(motion);
  return held;
}

Json describe_space_section(const fem::SpaceSection& s) {
  Json json{{"axial_stiffness_n", s.axial_stiffness},
            {"bending_stiffness_y_n_m2", s.bending_stiffness_y},
            {"bending_stiffness_z_n_m2", s.bending_stiffness_z},
            {"torsional_stiffness_n_m2", s.torsional_stiffness},
            {"mass_per_length_kg_per_m", s.mass_per_length},
            {"torsional_inertia_kg_m", s.torsional_inertia}};
  if (s.shear_stiffness_y) json["shear_stiffness_y_n"] = *s.shear_stiffness_y;
  if (s.shear_stiffness_z) json["shear_stiffness_z_n"] = *s.shear_stiffness_z;
  if (s.rotary_inertia_y > 0.0) json["rotary_inertia_y_kg_m"] = s.rotary_inertia_y;
  if (s.rotary_inertia_z > 0.0) json["rotary_inertia_z_kg_m"] = s.rotary_inertia_z;
  return json;
}

Json describe_space_member(const SpaceFrame& frame, std::size_t i) {
  const SpaceFrame::Member& member = frame.members[i];
  Json json{{"length_m", frame.length(i)}, {"section_z", numbers_of(frame.axes(i).col(2))}};
  json.update(describe_space_section(member.section));
  return json;
}

std::string space_joint_name(const SpaceFrame& frame, int joint) {
  const std::string& name = frame.joints[static_cast<std::size_t>(joint)].name;
  return name.empty() ? fmt::format("{}", joint + 1) : name;
}

// "x y z rx ry rz at 1, 2", the joints of each kind of support together.
std::string supports_text(const SpaceFrame& frame) {
  constexpr std::size_t most_shown = 8;
  std::vector<std::pair<std::string, std::vector<std::string>>> kinds;
  for (const SpaceFrame::Support& support : frame.supports) {
    const std::vector<std::string> held = held_by(support);
    std::string kind;
    for (const std::string& motion : held) kind += (kind.empty() ? "" : " ") + motion;
    if (held.size() == 6) kind = "clamped";
    auto at =
        std::find_if(kinds.begin(), kinds.end(), [&](const auto& known) { return known.first == kind; });
    if (at == kinds.end()) at = kinds.insert(kinds.end(), {kind, {}});
    at->second.push_back(space_joint_name(frame, support.joint));
  }
  std::string text;
  for (const auto& [kind, joints] : kinds) {
    text += "; " + (kind == "clamped" ? kind : "held in " + kind) + " at ";
    if (joints.size() > most_shown)
      text += fmt::format("{} joints", joints.size());
    else
      text += fmt::format("{}", fmt::join(joints, ", "));
  }
  return text.empty() ? "; nowhere held" : text;
}

}  // namespace

Json describe_members(const SpaceFrame& frame) {
  Json members = Json::array();
  for (std::size_t i = 0; i < frame.members.size(); ++i) members.push_back(describe_space_member(frame, i));
  return members;
}

std::string space_frame_text(const SpaceFrame& frame, int elements_per_member, Eigen::Index coordinates) {
  std::string text =
      fmt::format("Space frame: {} between {}, {:.6g} kg", counted(frame.members.size(), "member"),
                  counted(frame.joints.size(), "joint"), total_mass(frame)) +
      supports_text(frame);
  return text + attachments_text(frame) + mesh_text(frame, elements_per_member, coordinates);
}

double total_mass(const SpaceFrame& frame) {
  double sum = 0.0;
  for (std::size_t i = 0; i < frame.members.size(); ++i)
    sum += frame.members[i].section.mass_per_length * frame.length(i);
  for (const SpaceFrame::Body& body : frame.bodies) sum += body.mass;
  return sum;
}

}  // namespace beamid::experiments
