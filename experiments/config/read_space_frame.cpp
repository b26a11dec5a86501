#include "experiments/config/read_space_frame.hpp"

#include <fmt/format.h>

#include <numbers>

#include "experiments/config/key_tables.hpp"
#include "experiments/config/member_keys.hpp"
#include "experiments/config/read_space_attachments.hpp"
#include "experiments/config/space_section_keys.hpp"
#include "experiments/config/vector_keys.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Vector3d;
using fem::SpaceFrame;

/// What the keys of vectors and lists hold.
struct GivenSpaceFrame {
  int elements = 8;
  fem::MassModel mass_model = fem::MassModel::consistent;
  std::vector<double> base_direction;
};
struct GivenSpaceJoint {
  std::string name;
  double x = 0.0, y = 0.0, z = 0.0;
};
struct GivenSpaceMember {
  std::string section;
  std::vector<double> section_z, offset_at_first, offset_at_second;
  double roll_deg = 0.0;
  std::vector<std::string> released_at_first, released_at_second;
};
const Schema<GivenSpaceFrame>& space_frame_keys() {
  using F = GivenSpaceFrame;
  static const Schema<F> keys =
      Schema<F>("space_frame")
          .key("elements_per_member", &F::elements, {1, most_elements},
               "finite elements of each member, 1000000 in all at most", "20")
          .choice("mass_model", &F::mass_model,
                  {std::pair{"consistent", fem::MassModel::consistent}, {"lumped", fem::MassModel::lumped}},
                  "of the elements; frequencies err by h^4 or by h^2", "\"lumped\"")
          .key("base_direction", &F::base_direction,
               "in which all supports move together, where the base moves: x, y, z, of any length",
               "[0.6, 0.8, 0]")
          .fallback("`[1, 0, 0]`")
          .tables({"joints", "sections", "members", "supports", "bodies", "springs", "dashpots"});
  return keys;
}

const Schema<GivenSpaceJoint>& space_joint_keys() {
  using J = GivenSpaceJoint;
  static const Schema<J> keys =
      Schema<J>("space_frame.joints")
          .key("name", &J::name, "for reports and for places such as `roof.x`; without blanks and dots",
               "\"roof\"")
          .fallback("its number")
          .key("x_m", &J::x, "where it is", "3.0")
          .required()
          .key("y_m", &J::y, "where it is", "4.5")
          .required()
          .key("z_m", &J::z, "where it is; upwards in pictures", "3.2")
          .required();
  return keys;
}

const Schema<GivenSpaceMember>& space_member_keys() {
  using M = GivenSpaceMember;
  static const Schema<M> keys =
      between_joints(Schema<M>("space_frame.members"))
          .key("section", &M::section, "one of `[[space_frame.sections]]`, by its name", "\"column\"")
          .required()
          .key("section_z", &M::section_z,
               "where the section's z points, along which its height lies, as far as that is across the "
               "member",
               "[0, 0, 1]")
          .fallback("`[0, 0, 1]`, of members along z `[1, 0, 0]`")
          .key("roll_deg", &M::roll_deg, "of the section about the member, from there", "45")
          .key("released_at_first", &M::released_at_first,
               "moments that do not pass there, about the member's own axes: `\"x\"` torsion, `\"y\"`, "
               "`\"z\"` bending",
               "[\"y\", \"z\"]")
          .fallback("none")
          .key("released_at_second", &M::released_at_second, "the same at its other end",
               "[\"x\", \"y\", \"z\"]")
          .fallback("none")
          .key("offset_at_first_m", &M::offset_at_first, "of its end from the joint, rigidly: x, y, z",
               "[0, 0, 0.15]")
          .fallback("none")
          .key("offset_at_second_m", &M::offset_at_second, "the same at its other end", "[0, 0, -0.15]")
          .fallback("none")
          .like(common_member_keys());
  return keys;
}

const bool space_frame_keys_registered[] = {
    register_keys([]() -> const KeyTable& { return space_frame_keys(); }),
    register_keys([]() -> const KeyTable& { return space_joint_keys(); }),
    register_keys([]() -> const KeyTable& { return space_member_keys(); })};

SpaceFrame::Member read_space_member(const TomlTable& table, const SpaceFrame& frame,
                                     const std::map<std::string, fem::SpaceSection>& sections) {
  SpaceFrame::Member member;
  read_common(table, frame.joints.size(), member);
  const GivenSpaceMember given = space_member_keys().read(table);
  const auto section = sections.find(given.section);
  if (section == sections.end()) {
    std::vector<std::string> names;
    for (const auto& one : sections) names.push_back(one.first);
    table.refuse("section", "one of the sections " + joined(names));
  }
  member.section = section->second;
  if (table.contains("section_z")) member.section_z = vector_of(table, "section_z", given.section_z);
  member.roll = given.roll_deg * std::numbers::pi / 180.0;
  SpaceFrame::End &one = member.at_first, &other = member.at_second;
  set_named(table, "released_at_first", given.released_at_first,
            {{"x", &one.x}, {"y", &one.y}, {"z", &one.z}});
  set_named(table, "released_at_second", given.released_at_second,
            {{"x", &other.x}, {"y", &other.y}, {"z", &other.z}});
  one.offset = vector_of(table, "offset_at_first_m", given.offset_at_first);
  other.offset = vector_of(table, "offset_at_second_m", given.offset_at_second);
  return member;
}

/// Where it goes, how its section lies.
void check_space_geometry(const TomlTable& table, const SpaceFrame& frame, std::size_t i) {
  const SpaceFrame::Member& member = frame.members[i];
  if (!(frame.length(i) > 0.0))
    throw InputError(table.place(),
                     fmt::format("{} goes from joint {} to joint {} and has no length; expected ends at "
                                 "different places",
                                 table.name(), member.first + 1, member.second + 1));
  at_place(table.contains("section_z") ? table.value_place("section_z") : table.place(), [&] {
    try {
      frame.axes(i);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(table.name() + ": " + error.what());
    }
  });
}

}  // namespace

SpaceFrameExperiment read_space_frame(const TomlTable& table) {
  const GivenSpaceFrame given = space_frame_keys().read(table);
  SpaceFrameExperiment experiment{{}, given.elements};
  SpaceFrame& frame = experiment.frame;
  frame.mass_model = given.mass_model;
  frame.base_direction = vector_of(table, "base_direction", given.base_direction, Vector3d::UnitX());
  if (frame.base_direction.isZero(0.0)) table.refuse("base_direction", "three numbers, not all zero");
  for (const TomlTable& one : some_tables(table, "joints")) {
    const GivenSpaceJoint joint = space_joint_keys().read(one);
    add_joint(one, SpaceFrame::Joint{{joint.x, joint.y, joint.z}, joint.name}, frame.joints);
  }
  const auto sections = read_space_sections(table);
  for (const TomlTable& one : some_tables(table, "members")) {
    frame.members.push_back(read_space_member(one, frame, sections));
    check_space_geometry(one, frame, frame.members.size() - 1);
  }
  check_joints_connected(table, frame.joints.size(), fem::member_ends(frame));
  check_elements_per_member(table, frame.members.size());
  read_space_attachments(table, frame);
  check_frame(table, frame);
  return experiment;
}

}  // namespace beamid::experiments
