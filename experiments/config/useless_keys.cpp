#include "experiments/config/useless_keys.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/text/spelling.hpp"

namespace beamid::experiments {

std::vector<std::string> given_keys(const TomlTable& table, const std::vector<std::string>& keys) {
  std::vector<std::string> given;
  for (const std::string& key : keys)
    if (table.contains(key)) given.push_back(key);
  return given;
}

void refuse_useless(const TomlTable& table, const std::vector<std::string>& keys,
                    const std::string& circumstance, const std::string& expected) {
  for (const std::string& key : given_keys(table, keys))
    throw InputError(table.key_place(key), fmt::format("{} has no use {}; expected {}, or no {}",
                                                       table.path(key), circumstance, expected, key));
}

void refuse_all_but(const TomlTable& table, const std::vector<std::string>& useful,
                    const std::string& circumstance) {
  for (const std::string& key : table.keys())
    if (std::find(useful.begin(), useful.end(), key) == useful.end())
      throw InputError(table.key_place(key), fmt::format("{} has no use {}; of use there: {}",
                                                         table.path(key), circumstance, joined(useful)));
}

}  // namespace beamid::experiments
