
#include "experiments/config/readers.hpp"

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Core>

#include "experiments/config/key_tables.hpp"
#include "experiments/config/section_keys.hpp"
#include "experiments/text/spelling.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/space_frame.hpp"

namespace beamid::experiments {
namespace {

// Keys whose value is a vector in space or a choice of several names.

/// Three numbers of a key; `absent` where it is not given. @throws InputError where they are not three
Eigen::Vector3d vector_of(const TomlTable& table, const char* key, const std::vector<double>& values,
                          const Eigen::Vector3d& absent = Eigen::Vector3d::Zero());

using Eigen::Vector3d;

Vector3d vector_of(const TomlTable& table, const char* key, const std::vector<double>& values,
                   const Vector3d& absent) {
  if (!table.contains(key)) return absent;
  if (values.size() != 3) table.refuse(key, "three numbers, along x, y and z");
  return {values[0], values[1], values[2]};
}

/// Sets the flags that the texts of a key name. @throws InputError at a text that names none
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

// What holds a space frame and sits on it: [[space_frame.supports]], [[space_frame.bodies]],
// [[space_frame.springs]], [[space_frame.dashpots]].

/// Into a frame whose joints are known. @param table [space_frame]
/// @throws InputError naming file, line and column, what was found and what was expected.
void read_space_attachments(const TomlTable& table, fem::SpaceFrame& frame);

using fem::SpaceFrame;

/// What the keys of vectors and lists hold.
struct GivenSpaceSupport {
  std::string kind;
  std::vector<std::string> holds;
};
struct GivenSpaceBody {
  double mass = 0.0;
  std::vector<double> inertia, offset;
};
struct GivenSpaceCoefficients {
  std::vector<double> translational, rotational;
};

const Schema<GivenSpaceSupport>& space_support_keys() {
  using S = GivenSpaceSupport;
  static const Schema<S> keys =
      at_joint(Schema<S>("space_frame.supports"), "which joint is held", "1")
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
      at_joint(Schema<B>("space_frame.bodies"), "where", "2")
          .key("mass_kg", &B::mass, not_negative, "its mass", "120")
          .key("inertia_kg_m2", &B::inertia, not_negative, "about x, y and z through its own centre",
               "[3.5, 3.5, 5.0]")
          .fallback("none")
          .key("offset_m", &B::offset, "of its centre from the joint, rigidly: x, y, z", "[0, 0, 0.4]")
          .fallback("none")
          .at_least_one({"mass_kg", "inertia_kg_m2"});
  return keys;
}

struct CoefficientKey {
  const char *name, *meaning, *example;
};

/// Of springs or dashpots against the ground.
Schema<GivenSpaceCoefficients> coefficient_keys(const char* table, const char* joint,
                                                const CoefficientKey& translational,
                                                const CoefficientKey& rotational) {
  using G = GivenSpaceCoefficients;
  return at_joint(Schema<G>(table), joint, "3")
      .key(translational.name, &G::translational, not_negative, translational.meaning, translational.example)
      .fallback("none")
      .key(rotational.name, &G::rotational, not_negative, rotational.meaning, rotational.example)
      .fallback("none")
      .at_least_one({translational.name, rotational.name});
}

const Schema<GivenSpaceCoefficients>& space_spring_keys() {
  static const auto keys =
      coefficient_keys("space_frame.springs", "where",
                       {"translational_n_per_m", "k of forces along x, y and z", "[2e5, 2e5, 0]"},
                       {"rotational_n_m_per_rad", "k of moments about x, y and z", "[0, 0, 1e4]"});
  return keys;
}

const Schema<GivenSpaceCoefficients>& space_dashpot_keys() {
  static const auto keys =
      coefficient_keys("space_frame.dashpots", "where, against the ground",
                       {"translational_n_s_per_m", "c of velocities along x, y and z", "[150, 150, 0]"},
                       {"rotational_n_m_s_per_rad", "c of turning about x, y and z", "[0, 0, 20]"});
  return keys;
}

const bool space_attachment_keys_registered[] = {
    register_keys([]() -> const KeyTable& { return space_support_keys(); }),
    register_keys([]() -> const KeyTable& { return space_body_keys(); }),
    register_keys([]() -> const KeyTable& { return space_spring_keys(); }),
    register_keys([]() -> const KeyTable& { return space_dashpot_keys(); })};

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
    const GivenSpaceCoefficients given = space_spring_keys().read(one);
    frame.springs.push_back({read_joint(one, "joint", frame.joints.size()),
                             vector_of(one, "translational_n_per_m", given.translational),
                             vector_of(one, "rotational_n_m_per_rad", given.rotational)});
  }
  for (const TomlTable& one : table.find_tables("dashpots")) {
    const GivenSpaceCoefficients given = space_dashpot_keys().read(one);
    frame.dashpots.push_back({read_joint(one, "joint", frame.joints.size()),
                              vector_of(one, "translational_n_s_per_m", given.translational),
                              vector_of(one, "rotational_n_m_s_per_rad", given.rotational)});
  }
}

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
