
#include "experiments/config/readers.hpp"

#include <cmath>

#include <fmt/format.h>

#include "experiments/config/key_tables.hpp"
#include "experiments/config/section_keys.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/config/useless_keys.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/frame.hpp"

namespace beamid::experiments {
namespace {

// What holds a plane frame and sits on it: [[frame.supports]], [[frame.bodies]], [[frame.springs]],
// [[frame.dashpots]].

/// Into a frame whose joints are known. @param table [frame]
/// @throws InputError naming file, line and column, what was found and what was expected.
void read_frame_attachments(const TomlTable& table, fem::Frame& frame);

using fem::Frame;

std::vector<std::string> support_names() {
  std::vector<std::string> names;
  for (const auto& kind : frame_support_kinds()) names.push_back(kind.first);
  return names;
}

struct NamedFrameSupport {
  std::string kind;
};

const Schema<NamedFrameSupport>& frame_support_keys() {
  static const Schema<NamedFrameSupport> keys =
      at_joint(Schema<NamedFrameSupport>("frame.supports"), "which joint is held", "1")
          .key("kind", &NamedFrameSupport::kind, "how: see below", "\"pinned\"")
          .one_of(support_names())
          .required();
  return keys;
}

const Schema<Frame::Body>& frame_body_keys() {
  using B = Frame::Body;
  static const Schema<B> keys =
      at_joint(Schema<B>("frame.bodies"), "where", "2")
          .key("mass_kg", &B::mass, not_negative, "its mass", "120")
          .key("rotary_inertia_kg_m2", &B::rotary_inertia, not_negative, "about its own centre", "3.5")
          .at_least_one({"mass_kg", "rotary_inertia_kg_m2"});
  return keys;
}

const Schema<Frame::Spring>& frame_spring_keys() {
  using S = Frame::Spring;
  static const Schema<S> keys =
      at_joint(Schema<S>("frame.springs"), "where", "3")
          .key("translational_x_n_per_m", &S::x, not_negative, "k of a force along x", "2e5")
          .key("translational_y_n_per_m", &S::y, not_negative, "k of a force along y", "2e5")
          .key("rotational_n_m_per_rad", &S::rotational, not_negative, "k of a moment", "1e4")
          .at_least_one({"translational_x_n_per_m", "translational_y_n_per_m", "rotational_n_m_per_rad"});
  return keys;
}

const Schema<Frame::Dashpot>& frame_dashpot_keys() {
  using D = Frame::Dashpot;
  static const Schema<D> keys =
      at_joint(Schema<D>("frame.dashpots"), "where, against the ground", "3")
          .key("translational_x_n_s_per_m", &D::x, not_negative, "c of a velocity along x", "150")
          .key("translational_y_n_s_per_m", &D::y, not_negative, "c of a velocity along y", "150")
          .key("rotational_n_m_s_per_rad", &D::rotational, not_negative, "c of a turning", "20")
          .at_least_one(
              {"translational_x_n_s_per_m", "translational_y_n_s_per_m", "rotational_n_m_s_per_rad"});
  return keys;
}

const bool frame_attachment_keys_registered[] = {
    register_keys([]() -> const KeyTable& { return frame_support_keys(); }),
    register_keys([]() -> const KeyTable& { return frame_body_keys(); }),
    register_keys([]() -> const KeyTable& { return frame_spring_keys(); }),
    register_keys([]() -> const KeyTable& { return frame_dashpot_keys(); })};

void read_frame_attachments(const TomlTable& table, Frame& frame) {
  for (const TomlTable& one : table.find_tables("supports")) {
    const std::string name = frame_support_keys().read(one).kind;
    for (const auto& [kind, support] : frame_support_kinds())
      if (kind == name) frame.supports.push_back(support);
    frame.supports.back().joint = read_joint(one, "joint", frame.joints.size());
  }
  const auto read = [&](const char* name, const auto& keys, auto& attachments) {
    for (const TomlTable& one : table.find_tables(name)) {
      attachments.push_back(keys.read(one));
      attachments.back().joint = read_joint(one, "joint", frame.joints.size());
    }
  };
  read("bodies", frame_body_keys(), frame.bodies);
  read("springs", frame_spring_keys(), frame.springs);
  read("dashpots", frame_dashpot_keys(), frame.dashpots);
}

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
