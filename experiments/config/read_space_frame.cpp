#include "experiments/config/read_space_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "experiments/config/joint_keys.hpp"
#include "experiments/config/key_tables.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/schema.hpp"
#include "experiments/config/space_section_keys.hpp"
#include "experiments/text/method_choice.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Vector3d;
using fem::SpaceFrame;
using Type = Key::Type;

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
  std::string section, group;
  std::vector<double> section_z, offset_at_first, offset_at_second;
  double roll_deg = 0.0, stiffness_factor = 1.0;
  std::vector<std::string> released_at_first, released_at_second;
};
struct GivenSpaceSupport {
  std::string kind;
  std::vector<std::string> holds;
};
struct GivenSpaceBody {
  double mass = 0.0;
  std::vector<double> inertia, offset;
};
struct GivenSpaceSpring {
  std::vector<double> translational, rotational;
};

const Schema<GivenSpaceFrame>& space_frame_keys() {
  using F = GivenSpaceFrame;
  static const Schema<F> keys =
      Schema<F>("space_frame")
          .key("elements_per_member", &F::elements, {1, most_elements},
               "finite elements of each member, 1000000 in all at most", "20")
          .choice("mass_model", &F::mass_model,
                  {std::pair{"consistent", fem::MassModel::consistent}, {"lumped", fem::MassModel::lumped}},
                  "of the elements; frequencies err by h^4 or by h^2",
                  "\"lumped\"")
          .key("base_direction", &F::base_direction,
               "in which all supports move together, where the base moves: x, y, z, of any length",
               "[0.6, 0.8, 0]")
          .fallback("`[1, 0, 0]`")
          .tables({"joints", "sections", "members", "supports", "bodies", "springs"});
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
      Schema<M>("space_frame.members")
          .other("first", Type::whole, "the joint where it begins", "1", {1, most_elements})
          .values(joint_values)
          .required()
          .other("second", Type::whole, "the joint where it ends", "2", {1, most_elements})
          .values(joint_values)
          .required()
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
               "`\"z\"` "
               "bending",
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
          .key("stiffness_factor", &M::stiffness_factor, positive,
               "of E A, E I, G J and kappa G A: `0.8` for a member that has lost a fifth", "0.8")
          .key("group", &M::group,
               "members of one group share a factor that `[[parameters]]` can ask about, `quantity = "
               "\"factor\"` with the group as `name`",
               "\"columns\"")
          .fallback("none");
  return keys;
}

const Schema<GivenSpaceSupport>& space_support_keys() {
  using S = GivenSpaceSupport;
  static const Schema<S> keys =
      Schema<S>("space_frame.supports")
          .other("joint", Type::whole, "which joint is held", "1", {1, most_elements})
          .values(joint_values)
          .required()
          .key("kind", &S::kind, "all six motions, or the displacements alone", "\"pinned\"")
          .one_of({"clamped", "pinned"})
          .fallback("either this")
          .key("holds", &S::holds,
               "the displacements `x`, `y`, `z` and rotations `rx`, `ry`, `rz` that it holds",
               "[\"z\", \"rx\"]")
          .fallback("or this")
          .exactly_one("what the support holds", {"kind", "holds"});
  return keys;
}

const Schema<GivenSpaceBody>& space_body_keys() {
  using B = GivenSpaceBody;
  static const Schema<B> keys =
      Schema<B>("space_frame.bodies")
          .other("joint", Type::whole, "where", "2", {1, most_elements})
          .values(joint_values)
          .required()
          .key("mass_kg", &B::mass, not_negative, "its mass", "120")
          .key("inertia_kg_m2", &B::inertia, not_negative, "about x, y and z through its own centre",
               "[3.5, 3.5, 5.0]")
          .fallback("none")
          .key("offset_m", &B::offset, "of its centre from the joint, rigidly: x, y, z", "[0, 0, 0.4]")
          .fallback("none")
          .at_least_one({"mass_kg", "inertia_kg_m2"});
  return keys;
}

const Schema<GivenSpaceSpring>& space_spring_keys() {
  using S = GivenSpaceSpring;
  static const Schema<S> keys = Schema<S>("space_frame.springs")
                                    .other("joint", Type::whole, "where", "3", {1, most_elements})
                                    .values(joint_values)
                                    .required()
                                    .key("translational_n_per_m", &S::translational, not_negative,
                                         "k of forces along x, y and z", "[2e5, 2e5, 0]")
                                    .fallback("none")
                                    .key("rotational_n_m_per_rad", &S::rotational, not_negative,
                                         "k of moments about x, y and z", "[0, 0, 1e4]")
                                    .fallback("none")
                                    .at_least_one({"translational_n_per_m", "rotational_n_m_per_rad"});
  return keys;
}

const bool space_frame_keys_registered[] = {
    register_keys([]() -> const KeyTable& { return space_frame_keys(); }),
    register_keys([]() -> const KeyTable& { return space_joint_keys(); }),
    register_keys([]() -> const KeyTable& { return space_member_keys(); }),
    register_keys([]() -> const KeyTable& { return space_support_keys(); }),
    register_keys([]() -> const KeyTable& { return space_body_keys(); }),
    register_keys([]() -> const KeyTable& { return space_spring_keys(); })};

/// Three numbers of a key; `absent` where it is not given.
Vector3d vector_of(const TomlTable& table, const char* key, const std::vector<double>& values,
                   const Vector3d& absent = Vector3d::Zero()) {
  if (!table.contains(key)) return absent;
  if (values.size() != 3) table.refuse(key, "three numbers, along x, y and z");
  return {values[0], values[1], values[2]};
}

/// Sets the flags that the texts of a key name.
void set_named(const TomlTable& table, const char* key, const std::vector<std::string>& given,
               const std::vector<std::pair<std::string, bool*>>& flags) {
  std::vector<std::string> names;
  for (const auto& flag : flags) names.push_back(flag.first);
  for (const std::string& name : given) {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) table.refuse(key, "texts from " + joined(names));
    *flags[static_cast<std::size_t>(at - names.begin())].second = true;
  }
}

SpaceFrame::Member read_space_member(const TomlTable& table, const SpaceFrame& frame,
                                     const std::map<std::string, fem::SpaceSection>& sections) {
  SpaceFrame::Member member;
  member.first = read_joint(table, "first", frame.joints.size());
  member.second = read_joint(table, "second", frame.joints.size());
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
  member.stiffness_factor = given.stiffness_factor;
  member.group = given.group;
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

SpaceFrame::Support read_space_support(const TomlTable& table, const SpaceFrame& frame) {
  const GivenSpaceSupport given = space_support_keys().read(table);
  const bool all = given.kind == "clamped", pinned = all || given.kind == "pinned";
  SpaceFrame::Support support{
      read_joint(table, "joint", frame.joints.size()), pinned, pinned, pinned, all, all, all};
  set_named(table, "holds", given.holds,
            {{"x", &support.x},
             {"y", &support.y},
             {"z", &support.z},
             {"rx", &support.rx},
             {"ry", &support.ry},
             {"rz", &support.rz}});
  return support;
}

void read_space_attachments(const TomlTable& table, SpaceFrame& frame) {
  for (const TomlTable& one : table.find_tables("supports"))
    frame.supports.push_back(read_space_support(one, frame));
  for (const TomlTable& one : table.find_tables("bodies")) {
    const GivenSpaceBody given = space_body_keys().read(one);
    frame.bodies.push_back({read_joint(one, "joint", frame.joints.size()), given.mass,
                            vector_of(one, "inertia_kg_m2", given.inertia),
                            vector_of(one, "offset_m", given.offset)});
  }
  for (const TomlTable& one : table.find_tables("springs")) {
    const GivenSpaceSpring given = space_spring_keys().read(one);
    frame.springs.push_back({read_joint(one, "joint", frame.joints.size()),
                             vector_of(one, "translational_n_per_m", given.translational),
                             vector_of(one, "rotational_n_m_per_rad", given.rotational)});
  }
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
  const int most = std::max(1, most_elements / static_cast<int>(frame.members.size()));
  table.find_whole_number("elements_per_member", 1, most);
  read_space_attachments(table, frame);
  at_place(table.place(), [&] { fem::validate(frame); });
  return experiment;
}

}  // namespace beamid::experiments
