#include "experiments/config/read_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/config/joint_keys.hpp"
#include "experiments/config/key_json.hpp"
#include "experiments/config/key_tables.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/read_segment.hpp"
#include "experiments/config/section_keys.hpp"
#include "experiments/config/useless_keys.hpp"
#include "experiments/text/method_choice.hpp"
#include "fem/buckling.hpp"

namespace beamid::experiments {
namespace {

using fem::Frame;
using Type = Key::Type;

const Schema<FrameExperiment>& frame_keys() {
  using F = FrameExperiment;
  static const Schema<F> keys =
      Schema<F>("frame")
          .key("elements_per_member", &F::elements_per_member, {1, most_elements},
               "finite elements of each member, 1000000 in all at most", "40")
          .choice(
              "mass_model", [](F& f) -> fem::MassModel& { return f.frame.mass_model; },
              {std::pair{"consistent", fem::MassModel::consistent}, {"lumped", fem::MassModel::lumped}},
              "of the elements; frequencies err by h^4 or by h^2",
              "\"lumped\"")
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
  double stiffness_factor = 1.0;
  std::string group;
  double axial_load = 0.0;
};

const Schema<MemberValues>& member_keys() {
  using M = MemberValues;
  static const Schema<M> keys =
      Schema<M>("frame.members")
          .other("first", Type::whole, "the joint where it begins", "1", {1, most_elements})
          .values(joint_values)
          .required()
          .other("second", Type::whole, "the joint where it ends", "2", {1, most_elements})
          .values(joint_values)
          .required()
          .key("hinged_at_first", &M::hinged_at_first, "no moment passes there", "true")
          .key("hinged_at_second", &M::hinged_at_second, "no moment passes there", "true")
          .key("axial_stiffness_n", &M::axial_stiffness, positive,
               "E A itself; must be given beside `bending_stiffness_n_m2`", "1.2e8")
          .fallback("E A, from Young's modulus and the section")
          .key("stiffness_factor", &M::stiffness_factor, positive,
               "of E I, E A and kappa G A: `0.8` for a member that has lost a fifth", "0.8")
          .key("group", &M::group,
               "members of one group share a factor that `[[parameters]]` can ask about, `quantity = "
               "\"factor\"` with the group as `name`",
               "\"columns\"")
          .fallback("none")
          .key("axial_load_n", &M::axial_load,
               "P, positive in compression: what the member carries at rest, which softens it", "5e4")
          .like(section_keys());
  return keys;
}

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
      Schema<NamedFrameSupport>("frame.supports")
          .other("joint", Type::whole, "which joint is held", "1", {1, most_elements})
          .values(joint_values)
          .required()
          .key("kind", &NamedFrameSupport::kind, "how: see below", "\"pinned\"")
          .one_of(support_names())
          .required();
  return keys;
}

const Schema<Frame::Body>& frame_body_keys() {
  using B = Frame::Body;
  static const Schema<B> keys =
      Schema<B>("frame.bodies")
          .other("joint", Type::whole, "where", "2", {1, most_elements})
          .values(joint_values)
          .required()
          .key("mass_kg", &B::mass, not_negative, "its mass", "120")
          .key("rotary_inertia_kg_m2", &B::rotary_inertia, not_negative, "about its own centre", "3.5")
          .at_least_one({"mass_kg", "rotary_inertia_kg_m2"});
  return keys;
}

const Schema<Frame::Spring>& frame_spring_keys() {
  using S = Frame::Spring;
  static const Schema<S> keys =
      Schema<S>("frame.springs")
          .other("joint", Type::whole, "where", "3", {1, most_elements})
          .values(joint_values)
          .required()
          .key("translational_x_n_per_m", &S::x, not_negative, "k of a force along x", "2e5")
          .key("translational_y_n_per_m", &S::y, not_negative, "k of a force along y", "2e5")
          .key("rotational_n_m_per_rad", &S::rotational, not_negative, "k of a moment", "1e4")
          .at_least_one({"translational_x_n_per_m", "translational_y_n_per_m", "rotational_n_m_per_rad"});
  return keys;
}

const Schema<Frame::Dashpot>& frame_dashpot_keys() {
  using D = Frame::Dashpot;
  static const Schema<D> keys =
      Schema<D>("frame.dashpots")
          .other("joint", Type::whole, "where, against the ground", "3", {1, most_elements})
          .values(joint_values)
          .required()
          .key("translational_x_n_s_per_m", &D::x, not_negative, "c of a velocity along x", "150")
          .key("translational_y_n_s_per_m", &D::y, not_negative, "c of a velocity along y", "150")
          .key("rotational_n_m_s_per_rad", &D::rotational, not_negative, "c of a turning", "20")
          .at_least_one(
              {"translational_x_n_s_per_m", "translational_y_n_s_per_m", "rotational_n_m_s_per_rad"});
  return keys;
}

const bool frame_keys_registered[] = {
    register_keys([]() -> const KeyTable& { return frame_keys(); }),
    register_keys([]() -> const KeyTable& { return joint_keys(); }),
    register_keys([]() -> const KeyTable& { return member_keys(); }),
    register_keys([]() -> const KeyTable& { return frame_support_keys(); }),
    register_keys([]() -> const KeyTable& { return frame_body_keys(); }),
    register_keys([]() -> const KeyTable& { return frame_spring_keys(); }),
    register_keys([]() -> const KeyTable& { return frame_dashpot_keys(); })};

int joint(const TomlTable& table, const std::string& key, const Frame& frame) {
  return read_joint(table, key, frame.joints.size());
}

Frame::Member read_member(const TomlTable& table, Frame& frame) {
  Frame::Member member;
  member.first = joint(table, "first", frame);
  member.second = joint(table, "second", frame);
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
  member.stiffness_factor = given.stiffness_factor;
  member.group = given.group;
  member.axial_load = given.axial_load;
  fem::Beam alone;
  alone.segments = {{length, member.section}};
  at_place(table.place(), [&] { fem::validate(alone); });
  return member;
}

void read_members(const TomlTable& table, Frame& frame) {
  for (const TomlTable& one : some_tables(table, "members")) frame.members.push_back(read_member(one, frame));
  check_joints_connected(table, frame.joints.size(), fem::member_ends(frame));
}

void read_frame_attachments(const TomlTable& table, Frame& frame) {
  for (const TomlTable& one : table.find_tables("supports")) {
    const std::string name = frame_support_keys().read(one).kind;
    for (const auto& [kind, support] : frame_support_kinds())
      if (kind == name) frame.supports.push_back(support);
    frame.supports.back().joint = joint(one, "joint", frame);
  }
  for (const TomlTable& one : table.find_tables("bodies")) {
    frame.bodies.push_back(frame_body_keys().read(one));
    frame.bodies.back().joint = joint(one, "joint", frame);
  }
  for (const TomlTable& one : table.find_tables("springs")) {
    frame.springs.push_back(frame_spring_keys().read(one));
    frame.springs.back().joint = joint(one, "joint", frame);
  }
  for (const TomlTable& one : table.find_tables("dashpots")) {
    frame.dashpots.push_back(frame_dashpot_keys().read(one));
    frame.dashpots.back().joint = joint(one, "joint", frame);
  }
}

}  // namespace

void describe_frame_attachments(const Frame& frame, nlohmann::ordered_json& json) {
  const auto add = [&](const char* name, int joint,
                       const std::vector<std::pair<std::string, KeyValue>>& values) {
    nlohmann::ordered_json one{{"joint", joint + 1}};
    one.update(to_json(values));
    json[name].push_back(std::move(one));
  };
  for (const auto& support : frame.supports)
    add("supports", support.joint, frame_support_keys().values_of({frame_support_kind(support)}));
  for (const auto& body : frame.bodies) add("bodies", body.joint, frame_body_keys().values_of(body));
  for (const auto& spring : frame.springs)
    add("springs", spring.joint, frame_spring_keys().values_of(spring));
  for (const auto& dashpot : frame.dashpots)
    add("dashpots", dashpot.joint, frame_dashpot_keys().values_of(dashpot));
}

FrameExperiment read_frame(const std::filesystem::path& file) {
  return read_frame(TomlTable::read(file));
}

FrameExperiment read_frame(const TomlTable& root) {
  refuse_unknown_keys(root);
  check_values(root);
  FrameExperiment experiment = read_frame_table(root.table("frame"));
  experiment.title = root.find_text("title").value_or("");
  return experiment;
}

// On a mesh that serves for the buckling of members alone, too; where that is large, the modes say it.
void refuse_buckled_frame(const TomlTable& table, const Frame& frame) {
  constexpr std::size_t most_members = 150;
  const bool pressed = std::any_of(frame.members.begin(), frame.members.end(),
                                   [](const Frame::Member& one) { return one.axial_load > 0.0; });
  if (!pressed || frame.members.size() > most_members) return;
  const auto factor = fem::buckling_factor(frame);
  if (factor && *factor <= 1.0)
    throw InputError(
        table.place(),
        fmt::format("the frame buckles at {:.6g} times the axial_load_n of its members; expected "
                    "loads that it bears",
                    *factor));
}

FrameExperiment read_frame_table(const TomlTable& table) {
  FrameExperiment experiment = frame_keys().read(table);
  Frame& frame = experiment.frame;
  for (const TomlTable& one : some_tables(table, "joints"))
    add_joint(one, joint_keys().read(one), frame.joints);
  read_members(table, frame);
  const int most = std::max(1, most_elements / static_cast<int>(frame.members.size()));
  table.find_whole_number("elements_per_member", 1, most);
  read_frame_attachments(table, frame);
  experiment.joint_names = as_frame_experiment(frame, 1, "").joint_names;
  at_place(table.place(), [&] { fem::validate(frame); });
  refuse_buckled_frame(table, frame);
  return experiment;
}

}  // namespace beamid::experiments
