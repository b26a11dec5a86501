// What `beamid identifiability` looks at: [identifiability].
#pragma once

#include "experiments/identifiability/settings.hpp"
#include "experiments/input/toml_table.hpp"

namespace beamid::experiments {

/// @throws InputError at a value of the wrong type or out of range.
IdentifiabilitySettings read_identifiability(const TomlTable& table);

}  // namespace beamid::experiments
