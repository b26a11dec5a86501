// The methods chosen: [reduction], [model], [filter], and what is compared: [[reductions]], [[filters]],
// [compare].
#pragma once

#include "experiments/config/experiment.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

/// Methods are completed with the defaults of their options; an absent table means the Experiment's own
/// default.
/// @param root table of the file. @throws InputError at an unknown method, discretisation or option.
void read_methods(const TomlTable& root, Experiment& experiment);

}  // namespace beamid::experiments
