// The names that a suite of contracts runs on.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace beamid::test {

/// Everything that this program registers of a kind.
template <class Registry>
std::vector<std::string> names_in(const Registry& registry) {
  std::vector<std::string> names;
  for (const auto& [name, entry] : registry.entries()) names.push_back(name);
  return names;
}

/// A test is called after the method that it runs on.
inline std::string by_name(const testing::TestParamInfo<std::string>& tested) {
  return tested.param;
}

/// Oracle: what a user reads in `beamid list`.
template <class Entry>
void expect_described(const Entry& entry) {
  EXPECT_FALSE(entry.summary.empty());
  for (const auto& option : entry.options) EXPECT_FALSE(option.description.empty()) << option.name;
}

}  // namespace beamid::test
