// What the readers of plane and space frames share of members and of all that sits at a joint.
#pragma once

#include "experiments/config/joint_keys.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/schema.hpp"
#include "experiments/text/method_choice.hpp"
#include "fem/frame.hpp"
#include "fem/space_frame.hpp"

namespace beamid::experiments {

/// Begins the keys of what sits at one joint.
template <class T>
Schema<T>& at_joint(Schema<T>&& keys, const char* meaning, const char* example) {
  return keys.other("joint", Key::Type::whole, meaning, example, {1, most_elements})
      .values(joint_values)
      .required();
}

/// Begins the keys of what goes from one joint to another.
template <class T>
Schema<T>& between_joints(Schema<T>&& keys) {
  return keys.other("first", Key::Type::whole, "the joint where it begins", "1", {1, most_elements})
      .values(joint_values)
      .required()
      .other("second", Key::Type::whole, "the joint where it ends", "2", {1, most_elements})
      .values(joint_values)
      .required();
}

/// Keys that the members of all frames have beside `first` and `second`.
struct GivenMember {
  double stiffness_factor = 1.0;
  std::string group;
  double axial_load = 0.0;
};
const Schema<GivenMember>& common_member_keys();

/// Those, and the joints of a member.
template <class Member>
void read_common(const TomlTable& table, std::size_t joints, Member& member) {
  member.first = read_joint(table, "first", joints);
  member.second = read_joint(table, "second", joints);
  const GivenMember given = common_member_keys().read(table);
  member.stiffness_factor = given.stiffness_factor;
  member.group = given.group;
  member.axial_load = given.axial_load;
}

/// @throws InputError where the frame's members have so many elements that all together are too many.
void check_elements_per_member(const TomlTable& table, std::size_t members);

/// @throws InputError at the frame's table where its members bear more than buckles it. A frame of very many
/// members is not looked at: its modes say it.
void refuse_buckled(const TomlTable& table, const fem::Frame& frame);
void refuse_buckled(const TomlTable& table, const fem::SpaceFrame& frame);

/// Whatever the tables of its parts could not show. @throws InputError at the frame's table
template <class AnyFrame>
void check_frame(const TomlTable& table, const AnyFrame& frame) {
  at_place(table.place(), [&] { fem::validate(frame); });
  refuse_buckled(table, frame);
}

}  // namespace beamid::experiments
