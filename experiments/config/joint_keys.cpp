#include "experiments/config/joint_keys.hpp"

namespace beamid::experiments {

int read_joint(const TomlTable& table, const std::string& key, std::size_t joints) {
  const auto count = static_cast<int>(joints);
  const auto number = table.find_whole_number(key, 1, count);
  if (!number) table.miss(key, fmt::format("the number of a joint, from 1 to {}", count));
  return *number - 1;
}

std::vector<TomlTable> some_tables(const TomlTable& table, const std::string& key) {
  std::vector<TomlTable> tables = table.find_tables(key);
  if (tables.empty()) table.miss(key, "an array of at least one table");
  return tables;
}

void check_joints_connected(const TomlTable& table, std::size_t joints,
                            const std::vector<fem::MemberEnds>& members) {
  std::vector<bool> used(joints, false);
  for (const fem::MemberEnds& member : members)
    used[static_cast<std::size_t>(member.first)] = used[static_cast<std::size_t>(member.second)] = true;
  const std::vector<TomlTable> described = table.find_tables("joints");
  for (std::size_t i = 0; i < joints; ++i)
    if (!used[i])
      throw InputError(described[i].place(), described[i].name() + " ends no member; expected one at least");
  const int apart = fem::first_joint_apart(static_cast<int>(joints), members);
  if (apart < 0) return;
  const TomlTable& joint = described[static_cast<std::size_t>(apart)];
  throw InputError(
      joint.place(),
      joint.name() + " is not connected with the first; expected members between all parts of the frame");
}

}  // namespace beamid::experiments
