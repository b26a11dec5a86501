// An experiment from its TOML file.
#pragma once

#include <filesystem>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

/// Reads and checks the file; docs/configuration.md lists the keys.
///
/// Methods are completed with the defaults of their options. The record's file is neither read nor looked
/// for.
/// @param overrides keys set from outside the file.
/// @throws InputError naming file, line and column, what was found and what was expected.
Experiment read_experiment(const std::filesystem::path& file, const std::vector<Override>& overrides = {});

/// The same of a file already parsed. @param root its root table.
Experiment read_experiment(const TomlTable& root);

/// More than any mesh needs.
inline constexpr int most_elements = 1000000;

}  // namespace beamid::experiments
