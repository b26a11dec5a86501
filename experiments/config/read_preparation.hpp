// The tables [[record.prepare]] of an experiment file.
#pragma once

#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

/// The steps in the order of the file, every one with all of its options.
/// @param record the table [record]
/// @throws InputError at an unknown step, at a bad option, or at the step that misses one.
std::vector<Choice> read_preparation(const TomlTable& record);

}  // namespace beamid::experiments
