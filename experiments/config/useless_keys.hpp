// Keys that would be read and change nothing are refused, or a mistake goes unnoticed.
#pragma once

#include <string>
#include <vector>

#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

/// Those of the keys that the table holds, in the order given.
std::vector<std::string> given_keys(const TomlTable& table, const std::vector<std::string>& keys);

/// @throws InputError "beam.shear_factor has no use with theory "euler_bernoulli"; expected theory =
/// "timoshenko", or no shear_factor" at the first of the keys that the table holds.
void refuse_useless(const TomlTable& table, const std::vector<std::string>& keys,
                    const std::string& circumstance, const std::string& expected);

/// @throws InputError at the first key of the table that is none of `useful`.
void refuse_all_but(const TomlTable& table, const std::vector<std::string>& useful,
                    const std::string& circumstance);

}  // namespace beamid::experiments
