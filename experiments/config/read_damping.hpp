// The table [damping] of an experiment file.
#pragma once

#include "experiments/text/toml_table.hpp"
#include "fem/damping.hpp"

namespace beamid::experiments {

/// law = "none", "modal", "rayleigh", "caughey" or "structural", and what that law needs.
/// @throws InputError for a missing, a useless or an impossible value.
fem::DampingLaw read_damping(const TomlTable& table);

}  // namespace beamid::experiments
