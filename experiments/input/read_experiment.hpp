// An experiment from its TOML file.
#pragma once

#include <filesystem>

#include "experiments/experiment.hpp"

namespace beamid::experiments {

/// Reads and checks the file; docs/configuration.md lists the keys.
///
/// Methods are completed with the defaults of their options. The record's file is neither read nor looked
/// for.
/// @throws InputError naming file, line and column, what was found and what was expected.
Experiment read_experiment(const std::filesystem::path& file);

}  // namespace beamid::experiments
