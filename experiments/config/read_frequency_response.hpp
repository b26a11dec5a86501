// The table [frequency_response] of an experiment file.
#pragma once

#include "experiments/config/settings.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

/// @param length of the beam, to which every position must belong [m].
/// @throws InputError for a useless or a bad value.
FrequencyResponseSettings read_frequency_response(const TomlTable& table, const fem::Structure& structure);

}  // namespace beamid::experiments
