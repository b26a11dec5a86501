#include "experiments/config/frame_description.hpp"

#include <fmt/format.h>

#include "experiments/config/beam_description.hpp"
#include "experiments/config/frame_text.hpp"
#include "experiments/config/read_frame_attachments.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

Json describe_member(const fem::Frame& frame, std::size_t i) {
  const fem::Frame::Member& member = frame.members[i];
  Json json{{"first", member.first + 1}, {"second", member.second + 1}};
  json.update(describe(fem::Segment{frame.length(i), member.section}));
  if (member.hinged_at_first) json["hinged_at_first"] = true;
  if (member.hinged_at_second) json["hinged_at_second"] = true;
  if (member.stiffness_factor != 1.0) json["stiffness_factor"] = member.stiffness_factor;
  if (!member.group.empty()) json["group"] = member.group;
  if (member.axial_load != 0.0) json["axial_load_n"] = member.axial_load;
  return json;
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

FrameExperiment as_frame_experiment(const fem::Frame& frame, int elements_per_member,
                                    const std::string& title) {
  FrameExperiment experiment{title, frame, {}, elements_per_member};
  for (std::size_t i = 0; i < frame.joints.size(); ++i)
    experiment.joint_names.push_back(frame.joints[i].name.empty() ? fmt::format("{}", i + 1)
                                                                  : frame.joints[i].name);
  return experiment;
}

std::string frame_support_kind(const fem::Frame::Support& support) {
  for (const auto& [name, kind] : frame_support_kinds())
    if (kind.x == support.x && kind.y == support.y && kind.rotation == support.rotation) return name;
  return "free";
}

Json describe(const FrameExperiment& experiment) {
  const fem::Frame& frame = experiment.frame;
  Json json{{"elements_per_member", experiment.elements_per_member},
            {"mass_model", frame.mass_model == fem::MassModel::lumped ? "lumped" : "consistent"}};
  for (std::size_t i = 0; i < frame.joints.size(); ++i)
    json["joints"].push_back(
        {{"name", experiment.joint_names[i]}, {"x_m", frame.joints[i].x}, {"y_m", frame.joints[i].y}});
  for (std::size_t i = 0; i < frame.members.size(); ++i) json["members"].push_back(describe_member(frame, i));
  describe_frame_attachments(frame, json);
  return {{"title", experiment.title}, {"frame", json}};
}

std::string frame_text(const FrameExperiment& experiment, Eigen::Index coordinates) {
  const fem::Frame& frame = experiment.frame;
  std::string text =
      fmt::format("Plane frame: {} between {}, {:.6g} kg", counted(frame.members.size(), "member"),
                  counted(frame.joints.size(), "joint"), total_mass(frame));
  std::string held;
  for (const auto& [name, kind] : frame_support_kinds()) {
    std::string joints;
    for (const fem::Frame::Support& support : frame.supports)
      if (frame_support_kind(support) == name)
        joints += (joints.empty() ? "" : ", ") + experiment.joint_names[support.joint];
    if (!joints.empty()) held += fmt::format("; {} at {}", name, joints);
  }
  text += held.empty() ? "; nowhere held" : held;
  return text + attachments_text(frame) + mesh_text(frame, experiment.elements_per_member, coordinates);
}

double total_mass(const fem::Frame& frame) {
  double sum = 0.0;
  for (std::size_t i = 0; i < frame.members.size(); ++i)
    sum += frame.members[i].section.mass_per_length.mean() * frame.length(i);
  for (const fem::Frame::Body& body : frame.bodies) sum += body.mass;
  return sum;
}

}  // namespace beamid::experiments
