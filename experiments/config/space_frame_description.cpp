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

std::vector<std::string> released_of(const SpaceFrame::End& end) {
  std::vector<std::string> released;
  for (const auto& [free, axis] : {std::pair{end.x, "x"}, {end.y, "y"}, {end.z, "z"}})
    if (free) released.emplace_back(axis);
  return released;
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
  Json json{{"first", member.first + 1},
            {"second", member.second + 1},
            {"length_m", frame.length(i)},
            {"section_z", numbers_of(frame.axes(i).col(2))}};
  json.update(describe_space_section(member.section));
  for (const auto& [end, name] : {std::pair{&member.at_first, "first"}, {&member.at_second, "second"}}) {
    if (const auto released = released_of(*end); !released.empty())
      json[std::string("released_at_") + name] = released;
    if (!end->offset.isZero(0.0)) json[std::string("offset_at_") + name + "_m"] = numbers_of(end->offset);
  }
  if (member.stiffness_factor != 1.0) json["stiffness_factor"] = member.stiffness_factor;
  if (!member.group.empty()) json["group"] = member.group;
  if (member.axial_load != 0.0) json["axial_load_n"] = member.axial_load;
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

Json describe(const SpaceFrame& frame, int elements_per_member) {
  Json json{{"elements_per_member", elements_per_member},
            {"mass_model", frame.mass_model == fem::MassModel::lumped ? "lumped" : "consistent"},
            {"base_direction", numbers_of(frame.base_direction)}};
  for (std::size_t i = 0; i < frame.joints.size(); ++i) {
    const Eigen::Vector3d& place = frame.joints[i].place;
    json["joints"].push_back({{"name", space_joint_name(frame, static_cast<int>(i))},
                              {"x_m", place.x()},
                              {"y_m", place.y()},
                              {"z_m", place.z()}});
  }
  for (std::size_t i = 0; i < frame.members.size(); ++i)
    json["members"].push_back(describe_space_member(frame, i));
  for (const SpaceFrame::Support& support : frame.supports)
    json["supports"].push_back({{"joint", support.joint + 1}, {"holds", held_by(support)}});
  for (const SpaceFrame::Body& body : frame.bodies)
    json["bodies"].push_back({{"joint", body.joint + 1},
                              {"mass_kg", body.mass},
                              {"inertia_kg_m2", numbers_of(body.inertia)},
                              {"offset_m", numbers_of(body.offset)}});
  for (const SpaceFrame::Spring& spring : frame.springs)
    json["springs"].push_back({{"joint", spring.joint + 1},
                               {"translational_n_per_m", numbers_of(spring.translational)},
                               {"rotational_n_m_per_rad", numbers_of(spring.rotational)}});
  for (const SpaceFrame::Dashpot& dashpot : frame.dashpots)
    json["dashpots"].push_back({{"joint", dashpot.joint + 1},
                                {"translational_n_s_per_m", numbers_of(dashpot.translational)},
                                {"rotational_n_m_s_per_rad", numbers_of(dashpot.rotational)}});
  return json;
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
