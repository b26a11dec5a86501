// What the readers of plane and space frames share: joints by number, members that hang together.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "experiments/text/toml_table.hpp"
#include "fem/frame_graph.hpp"

namespace beamid::experiments {

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

}  // namespace beamid::experiments
