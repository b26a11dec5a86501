// The table [acquisition] of an experiment file, and the defects in [[sensors]].
#pragma once

#include "experiments/config/acquisition_settings.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

/// @param root the file's root. @throws InputError for an impossible value.
Acquisition read_acquisition(const TomlTable& root);

}  // namespace beamid::experiments
