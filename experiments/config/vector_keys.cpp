#include "experiments/config/vector_keys.hpp"

#include <algorithm>

#include "experiments/text/spelling.hpp"

namespace beamid::experiments {

using Eigen::Vector3d;

Vector3d vector_of(const TomlTable& table, const char* key, const std::vector<double>& values,
                   const Vector3d& absent) {
  if (!table.contains(key)) return absent;
  if (values.size() != 3) table.refuse(key, "three numbers, along x, y and z");
  return {values[0], values[1], values[2]};
}

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

}  // namespace beamid::experiments
