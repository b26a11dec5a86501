// What `beamid identifiability` looks at: [identifiability].
#pragma once

#include "experiments/config/identifiability_settings.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

/// @throws InputError at a value of the wrong type or out of range.
IdentifiabilitySettings read_identifiability(const TomlTable& table);

}  // namespace beamid::experiments
