#include "experiments/config/read_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/read_segment.hpp"
#include "experiments/config/useless_keys.hpp"
#include "experiments/config/vocabulary.hpp"
#include "experiments/text/method_choice.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

using fem::Frame;

double frame_value(const TomlTable& table, const std::string& key) {
  return table.find_number(key, Sign::not_negative).value_or(0.0);
}

/// A joint by its number from 1, as its number from 0.
int joint(const TomlTable& table, const std::string& key, const Frame& frame) {
  const auto count = static_cast<int>(frame.joints.size());
  const auto number = table.find_whole_number(key, 1, count);
  if (!number) table.miss(key, fmt::format("the number of a joint, from 1 to {}", count));
  return *number - 1;
}

void require_one_of(const TomlTable& table, const std::vector<std::string>& keys) {
  if (given_keys(table, keys).empty())
    throw InputError(table.place(), fmt::format("{} has no effect; expected at least one of {}", table.name(),
                                                joined(keys)));
}

std::vector<TomlTable> some(const TomlTable& table, const std::string& key) {
  std::vector<TomlTable> tables = table.find_tables(key);
  if (tables.empty()) table.miss(key, "an array of at least one table");
  return tables;
}

void read_joints(const TomlTable& table, FrameExperiment& experiment) {
  for (const TomlTable& one : some(table, "joints")) {
    const double x = one.number("x_m"), y = one.number("y_m");
    experiment.frame.joints.push_back({x, y});
    experiment.joint_names.push_back(
        one.find_text("name").value_or(fmt::format("{}", experiment.frame.joints.size())));
  }
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
  const auto axial = table.find_number("axial_stiffness_n", Sign::positive);
  member.section = read_section(table, length);
  if (axial) member.section.axial_stiffness = *axial;
  if (!member.section.axial_stiffness)
    table.miss("axial_stiffness_n", "a positive number beside bending_stiffness_n_m2");
  member.hinged_at_first = table.find_truth("hinged_at_first").value_or(false);
  member.hinged_at_second = table.find_truth("hinged_at_second").value_or(false);
  fem::Beam alone;
  alone.segments = {{length, member.section}};
  at_place(table.place(), [&] { fem::validate(alone); });
  return member;
}

void read_members(const TomlTable& table, Frame& frame) {
  std::vector<bool> used(frame.joints.size(), false);
  for (const TomlTable& one : some(table, "members")) {
    const Frame::Member member = read_member(one, frame);
    used[member.first] = used[member.second] = true;
    frame.members.push_back(member);
  }
  const std::vector<TomlTable> joints = table.find_tables("joints");
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (!used[i])
      throw InputError(joints[i].place(), joints[i].name() + " ends no member; expected one at least");
}

void read_frame_attachments(const TomlTable& table, Frame& frame) {
  std::vector<std::string> kinds;
  for (const auto& kind : frame_support_kinds()) kinds.push_back(kind.first);
  for (const TomlTable& one : table.find_tables("supports")) {
    const int where = joint(one, "joint", frame);
    const auto kind = one.find_text("kind", kinds);
    if (!kind) one.miss("kind", "one of " + joined(kinds));
    const auto found = std::find(kinds.begin(), kinds.end(), *kind) - kinds.begin();
    frame.supports.push_back(frame_support_kinds()[static_cast<std::size_t>(found)].second);
    frame.supports.back().joint = where;
  }
  for (const TomlTable& one : table.find_tables("bodies")) {
    const int where = joint(one, "joint", frame);
    frame.bodies.push_back({where, frame_value(one, "mass_kg"), frame_value(one, "rotary_inertia_kg_m2")});
    require_one_of(one, {"mass_kg", "rotary_inertia_kg_m2"});
  }
  for (const TomlTable& one : table.find_tables("springs")) {
    const int where = joint(one, "joint", frame);
    frame.springs.push_back({where, frame_value(one, "translational_x_n_per_m"),
                             frame_value(one, "translational_y_n_per_m"),
                             frame_value(one, "rotational_n_m_per_rad")});
    require_one_of(one, {"translational_x_n_per_m", "translational_y_n_per_m", "rotational_n_m_per_rad"});
  }
}

}  // namespace

const std::vector<std::string>& member_keys() {
  static const std::vector<std::string> keys = [] {
    std::vector<std::string> all{"first", "second", "hinged_at_first", "hinged_at_second",
                                 "axial_stiffness_n"};
    for (const std::string& key : segment_keys())
      if (key != "length_m") all.push_back(key);
    return all;
  }();
  return keys;
}

FrameExperiment read_frame(const std::filesystem::path& file) {
  return read_frame(TomlTable::read(file));
}

FrameExperiment read_frame(const TomlTable& root) {
  refuse_unknown_keys(root);
  FrameExperiment experiment;
  experiment.title = root.find_text("title").value_or("");
  const TomlTable table = root.table("frame");
  refuse_all_but(root, {"title", "frame"}, "beside [frame]");
  Frame& frame = experiment.frame;
  const auto mass_model = table.find_text("mass_model", {"consistent", "lumped"});
  frame.mass_model = mass_model == "lumped" ? fem::MassModel::lumped : fem::MassModel::consistent;
  read_joints(table, experiment);
  read_members(table, frame);
  const int most = std::max(1, most_elements / static_cast<int>(frame.members.size()));
  experiment.elements_per_member =
      table.find_whole_number("elements_per_member", 1, most).value_or(experiment.elements_per_member);
  read_frame_attachments(table, frame);
  at_place(table.place(), [&] { fem::validate(frame); });
  return experiment;
}

}  // namespace beamid::experiments
