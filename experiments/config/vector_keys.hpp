// Keys whose value is a vector in space or a choice of several names.
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

/// Three numbers of a key; `absent` where it is not given. @throws InputError where they are not three
Eigen::Vector3d vector_of(const TomlTable& table, const char* key, const std::vector<double>& values,
                          const Eigen::Vector3d& absent = Eigen::Vector3d::Zero());

/// Sets the flags that the texts of a key name. @throws InputError at a text that names none
void set_named(const TomlTable& table, const char* key, const std::vector<std::string>& given,
               const std::vector<std::pair<std::string, bool*>>& flags);

}  // namespace beamid::experiments
