// What may be wrong in the description of a frame, plane or in space.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <type_traits>

#include "experiments/identify/model_check/candidates.hpp"

namespace beamid::experiments {
namespace {

using fem::Frame, fem::SpaceFrame, fem::Structure;

constexpr std::size_t most_single_bodies = 20, most_single_supports = 8;
constexpr double plausible_compliance =
    0.1;                                // of a support, of what the members there have: 1 / sum(E I / L)
constexpr double ideal_support = 1e-7;  // likewise: what gives so little is as good as fixed

// What plane and space frames differ in.
double largest_bending_stiffness(const Frame::Member& member) {
  return member.stiffness_factor * member.section.bending_stiffness.mean();
}
double largest_bending_stiffness(const SpaceFrame::Member& member) {
  return member.stiffness_factor *
         std::max(member.section.bending_stiffness_y, member.section.bending_stiffness_z);
}

bool turns_with(const Frame::Member& member, bool first) {
  return !(first ? member.hinged_at_first : member.hinged_at_second);
}
bool turns_with(const SpaceFrame::Member& member, bool first) {
  const SpaceFrame::End& end = first ? member.at_first : member.at_second;
  return !end.x && !end.y && !end.z;
}

bool holds_rotation(const Frame::Support& support) {
  return support.rotation;
}
bool holds_rotation(const SpaceFrame::Support& support) {
  return support.rx && support.ry && support.rz;
}

void let_turn(Frame& frame, Frame::Support& support, double stiffness) {
  support.rotation = false;
  frame.springs.push_back({support.joint, 0.0, 0.0, stiffness});
}
void let_turn(SpaceFrame& frame, SpaceFrame::Support& support, double stiffness) {
  support.rx = support.ry = support.rz = false;
  frame.springs.push_back({support.joint, Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(stiffness)});
}

void scale_mass(fem::Section& section, double factor) {
  section.mass_per_length = fem::Variation(factor) * section.mass_per_length;
  section.rotary_inertia = fem::Variation(factor) * section.rotary_inertia;
}
void scale_mass(fem::SpaceSection& section, double factor) {
  section.mass_per_length *= factor, section.torsional_inertia *= factor;
  section.rotary_inertia_y *= factor, section.rotary_inertia_z *= factor;
}

void scale_body(Frame::Body& body, double factor) {
  body.mass *= factor, body.rotary_inertia *= factor;
}
void scale_body(SpaceFrame::Body& body, double factor) {
  body.mass *= factor, body.inertia *= factor;
}

void scale_spring(Frame::Spring& spring, double factor) {
  spring.x *= factor, spring.y *= factor, spring.rotational *= factor;
}
void scale_spring(SpaceFrame::Spring& spring, double factor) {
  spring.translational *= factor, spring.rotational *= factor;
}

template <class AnyFrame>
const AnyFrame& kind_of(const Structure& structure) {
  if constexpr (std::is_same_v<AnyFrame, Frame>)
    return *structure.frame();
  else
    return *structure.space_frame();
}

/// A relative change of what `f(frame, factor)` changes.
template <class AnyFrame, class Function>
Candidate frame_cause(const std::string& name, double plausible, const Function& f) {
  return relative_candidate(name, plausible, [f](const Structure& structure, double factor) {
    AnyFrame frame = kind_of<AnyFrame>(structure);
    f(frame, factor);
    return Structure(std::move(frame));
  });
}

template <class AnyFrame>
std::string name_of_joint(const AnyFrame& frame, int joint) {
  const std::string& name = frame.joints[static_cast<std::size_t>(joint)].name;
  return name.empty() ? std::to_string(joint + 1) : name;
}

/// 1 / sum(E I / L) of the members that turn with a joint [rad/(N m)]; infinite where none does.
template <class AnyFrame>
double member_flexibility(const AnyFrame& frame, int joint) {
  double stiffness = 0.0;
  for (std::size_t i = 0; i < frame.members.size(); ++i) {
    const auto& member = frame.members[i];
    for (const bool first : {true, false})
      if ((first ? member.first : member.second) == joint && turns_with(member, first))
        stiffness += largest_bending_stiffness(member) / frame.length(i);
  }
  return 1.0 / stiffness;
}

/// Joints whose rotation a support holds against members, and what these have.
template <class AnyFrame>
std::map<int, double> fixed_joints(const AnyFrame& frame) {
  std::map<int, double> fixed;
  for (const auto& support : frame.supports)
    if (const double flexibility = member_flexibility(frame, support.joint);
        holds_rotation(support) && std::isfinite(flexibility))
      fixed[support.joint] = flexibility;
  return fixed;
}

template <class AnyFrame>
Candidate compliance_candidate(const std::string& name, const std::map<int, double>& joints) {
  Candidate c = frame_cause<AnyFrame>(name, plausible_compliance, [](AnyFrame&, double) {});
  c.changed = [joints](const Structure& structure, double x) {
    AnyFrame frame = kind_of<AnyFrame>(structure);
    for (auto& support : frame.supports)
      if (const auto found = joints.find(support.joint); found != joints.end() && holds_rotation(support))
        let_turn(frame, support, 1.0 / ((std::max(0.0, x) + ideal_support) * found->second));
    return Structure(std::move(frame));
  };
  c.unit = c.value_unit = "of L/EI";
  c.lower = c.plausible_lower = 0.0;
  c.upper = 100.0 * plausible_compliance;
  c.value = [](const Structure&, double x) { return x; };
  return c;
}

template <class AnyFrame>
void add_bodies(const AnyFrame& frame, std::vector<Candidate>& all) {
  std::vector<int> joints;
  for (const auto& body : frame.bodies)
    if (body.mass > 0.0 && std::find(joints.begin(), joints.end(), body.joint) == joints.end())
      joints.push_back(body.joint);
  const auto of = [](int joint) {
    return [joint](AnyFrame& changed, double factor) {
      for (auto& body : changed.bodies)
        if (joint < 0 || body.joint == joint) scale_body(body, factor);
    };
  };
  if (joints.size() != 1 && !joints.empty()) all.push_back(frame_cause<AnyFrame>("body_mass", 0.05, of(-1)));
  if (joints.size() > most_single_bodies) return;
  for (const int joint : joints) {
    all.push_back(frame_cause<AnyFrame>("body_mass_" + name_of_joint(frame, joint), 0.2, of(joint)));
    all.back().exchangeable = true;
    all.back().value_unit = "kg";
    all.back().value = [joint](const Structure& structure, double x) {
      double mass = 0.0;
      for (const auto& body : kind_of<AnyFrame>(structure).bodies)
        mass += body.joint == joint ? body.mass : 0;
      return (1 + x) * mass;
    };
  }
}

template <class AnyFrame>
void add_supports(const AnyFrame& frame, std::vector<Candidate>& all) {
  for (std::size_t i = 0; i < frame.springs.size() && i < most_single_supports; ++i)
    all.push_back(frame_cause<AnyFrame>(
        "spring_" + name_of_joint(frame, frame.springs[i].joint), 0.3,
        [i](AnyFrame& changed, double factor) { scale_spring(changed.springs[i], factor); }));
  const std::map<int, double> fixed = fixed_joints(frame);
  if (!fixed.empty()) all.push_back(compliance_candidate<AnyFrame>("support_compliance", fixed));
  if (fixed.size() < 2 || fixed.size() > most_single_supports) return;
  for (const auto& one : fixed)
    all.push_back(
        compliance_candidate<AnyFrame>("support_compliance_" + name_of_joint(frame, one.first), {one}));
}

template <class AnyFrame>
std::vector<Candidate> candidates_of_frame(const AnyFrame& frame) {
  std::vector<Candidate> all;
  const std::vector<std::string> groups = fem::factor_names(frame);
  const bool one_group =
      groups.size() == 1 && std::none_of(frame.members.begin(), frame.members.end(),
                                         [](const auto& member) { return member.group.empty(); });
  const auto stiffness_of = [](const std::string& group) {
    return [group](AnyFrame& changed, double factor) {
      for (auto& member : changed.members)
        if (group.empty() || member.group == group) member.stiffness_factor *= factor;
    };
  };
  if (!one_group) all.push_back(frame_cause<AnyFrame>("youngs_modulus", 0.15, stiffness_of("")));
  for (const std::string& group : groups) {
    all.push_back(frame_cause<AnyFrame>(group, 0.3, stiffness_of(group)));
    all.back().label = "stiffness of " + group;
  }
  all.push_back(frame_cause<AnyFrame>("member_mass", 0.05, [](AnyFrame& changed, double factor) {
    for (auto& member : changed.members) scale_mass(member.section, factor);
  }));
  all.back().weighs_all = true;
  add_bodies(frame, all);
  add_supports(frame, all);
  if constexpr (std::is_same_v<AnyFrame, Frame>)
    if (std::any_of(frame.members.begin(), frame.members.end(),
                    [](const auto& member) { return member.axial_load != 0.0; }))
      all.push_back(frame_cause<AnyFrame>("axial_loads", 0.3, [](AnyFrame& changed, double factor) {
        for (auto& member : changed.members) member.axial_load *= factor;
      }));
  return all;
}

}  // namespace

std::vector<Candidate> frame_candidates(const Structure& structure) {
  return structure.frame() ? candidates_of_frame(*structure.frame())
                           : candidates_of_frame(*structure.space_frame());
}

}  // namespace beamid::experiments
