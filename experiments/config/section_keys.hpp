// The keys that describe a section and its material: of a beam of one segment, of a segment, of a frame's
// member.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/schema.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/frame.hpp"
#include "fem/space_frame.hpp"

namespace beamid::experiments {

/// What a file says of a section, in SI units; absent: not said.
struct GivenSection {
  std::optional<double> width, height, diameter, end_width, end_height, end_diameter;
  std::optional<double> youngs_modulus, bending_stiffness;
  std::optional<double> mass, mass_per_length, density;
  bool timoshenko = false;
  std::optional<double> poissons_ratio, shear_modulus, shear_factor, shear_stiffness;
  std::optional<bool> with_rotary_inertia;
  std::optional<double> rotary_inertia;
};

const Schema<GivenSection>& section_keys();

// The sections of a space frame, [[space_frame.sections]], which members name.

/// All sections by their names.
/// @param table [space_frame]
/// @throws InputError for missing, contradicting and useless keys, a bad value, and a name given twice.
std::map<std::string, fem::SpaceSection> read_space_sections(const TomlTable& table);

// What the readers of plane and space frames share of members and of all that sits at a joint.

// What the readers of plane and space frames share: joints by number, members that hang together.

inline constexpr const char* joint_values = "whole number, 1 to the number of joints";

/// A joint by its number from 1, as its number from 0.
int read_joint(const TomlTable& table, const std::string& key, std::size_t joints);

/// The tables of an array. @throws InputError where there is none.
std::vector<TomlTable> some_tables(const TomlTable& table, const std::string& key);

/// @throws InputError at the second of two joints with one name.
template <class Joint>
void add_joint(const TomlTable& table, const Joint& joint, std::vector<Joint>& joints) {
  for (const Joint& other : joints)
    if (!joint.name.empty() && joint.name == other.name)
      table.refuse("name", "a name that no other joint has");
  joints.push_back(joint);
}

/// @throws InputError at the first joint that ends no member or that no chain of members connects with the
/// first. @param table that of the frame
void check_joints_connected(const TomlTable& table, std::size_t joints,
                            const std::vector<fem::MemberEnds>& members);

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
