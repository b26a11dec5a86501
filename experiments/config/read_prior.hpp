// What is assumed before a record is seen: [prior] and [noise] of an experiment file.
#pragma once

#include "experiments/config/experiment.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

/// @param root of the file. @throws InputError at a value of the wrong type or out of range.
void read_prior(const TomlTable& root, Experiment& experiment);

}  // namespace beamid::experiments
