// What a record is compared by: [[filters]] and [compare].
#pragma once

#include "experiments/config/experiment.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

/// @param root table of the file. @throws InputError at an unknown filter, discretisation or option.
void read_comparison(const TomlTable& root, Experiment& experiment);

}  // namespace beamid::experiments
