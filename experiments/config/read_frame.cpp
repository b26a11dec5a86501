#include "experiments/config/read_frame.hpp"

#include <fmt/format.h>

#include <cmath>

#include "experiments/config/key_tables.hpp"
#include "experiments/config/member_keys.hpp"
#include "experiments/config/read_frame_attachments.hpp"
#include "experiments/config/read_segment.hpp"
#include "experiments/config/section_keys.hpp"
#include "experiments/config/useless_keys.hpp"

namespace beamid::experiments {
namespace {

using fem::Frame;

const Schema<FrameExperiment>& frame_keys() {
  using F = FrameExperiment;
  static const Schema<F> keys =
      Schema<F>("frame")
          .key("elements_per_member", &F::elements_per_member, {1, most_elements},
               "finite elements of each member, 1000000 in all at most", "40")
          .choice(
              "mass_model", [](F& f) -> fem::MassModel& { return f.frame.mass_model; },
              {std::pair{"consistent", fem::MassModel::consistent}, {"lumped", fem::MassModel::lumped}},
              "of the elements; frequencies err by h^4 or by h^2", "\"lumped\"")
          .choice(
              "base_motion", [](F& f) -> char& { return f.frame.base_axis; },
              {std::pair{"x", 'x'}, {"y", 'y'}},
              "along which axis all supports move together, where the base moves", "\"y\"")
          .tables({"joints", "members", "supports", "bodies", "springs", "dashpots"});
  return keys;
}

const Schema<Frame::Joint>& joint_keys() {
  using J = Frame::Joint;
  static const Schema<J> keys = Schema<J>("frame.joints")
                                    .key("name", &J::name,
                                         "for reports and for places such as `ridge.x`; without blanks "
                                         "and dots where it is one",
                                         "\"ridge\"")
                                    .fallback("its number")
                                    .key("x_m", &J::x, "where it is", "3.0")
                                    .required()
                                    .key("y_m", &J::y, "where it is", "4.5")
                                    .required();
  return keys;
}

struct MemberValues {
  std::optional<double> axial_stiffness;
  bool hinged_at_first = false, hinged_at_second = false;
};

const Schema<MemberValues>& member_keys() {
  using M = MemberValues;
  static const Schema<M> keys =
      between_joints(Schema<M>("frame.members"))
          .key("hinged_at_first", &M::hinged_at_first, "no moment passes there", "true")
          .key("hinged_at_second", &M::hinged_at_second, "no moment passes there", "true")
          .key("axial_stiffness_n", &M::axial_stiffness, positive,
               "E A itself; must be given beside `bending_stiffness_n_m2`", "1.2e8")
          .fallback("E A, from Young's modulus and the section")
          .like(common_member_keys())
          .like(section_keys());
  return keys;
}

const bool frame_keys_registered[] = {register_keys([]() -> const KeyTable& { return frame_keys(); }),
                                      register_keys([]() -> const KeyTable& { return joint_keys(); }),
                                      register_keys([]() -> const KeyTable& { return member_keys(); })};

Frame::Member read_member(const TomlTable& table, Frame& frame) {
  Frame::Member member;
  read_common(table, frame.joints.size(), member);
  const Frame::Joint &from = frame.joints[member.first], &to = frame.joints[member.second];
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  if (length == 0.0)
    throw InputError(table.place(),
                     fmt::format("{} goes from joint {} to joint {} and has no length; expected joints at "
                                 "different places",
                                 table.name(), member.first + 1, member.second + 1));
  const MemberValues given = member_keys().read(table);
  member.section = read_section(table, length);
  if (given.axial_stiffness) member.section.axial_stiffness = *given.axial_stiffness;
  if (!member.section.axial_stiffness)
    table.miss("axial_stiffness_n", "a positive number beside bending_stiffness_n_m2");
  member.hinged_at_first = given.hinged_at_first;
  member.hinged_at_second = given.hinged_at_second;
  fem::Beam alone;
  alone.segments = {{length, member.section}};
  at_place(table.place(), [&] { fem::validate(alone); });
  return member;
}

void read_members(const TomlTable& table, Frame& frame) {
  for (const TomlTable& one : some_tables(table, "members")) frame.members.push_back(read_member(one, frame));
  check_joints_connected(table, frame.joints.size(), fem::member_ends(frame));
}

}  // namespace

FrameExperiment read_frame(const TomlTable& table) {
  FrameExperiment experiment = frame_keys().read(table);
  Frame& frame = experiment.frame;
  for (const TomlTable& one : some_tables(table, "joints"))
    add_joint(one, joint_keys().read(one), frame.joints);
  read_members(table, frame);
  check_elements_per_member(table, frame.members.size());
  read_frame_attachments(table, frame);
  check_frame(table, frame);
  return experiment;
}

}  // namespace beamid::experiments
