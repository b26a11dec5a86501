// beamid identify --config A --config B ...: several beams at once.
#pragma once

#include <filesystem>
#include <vector>

#include "apps/command.hpp"
#include "apps/values.hpp"
#include "experiments/results/results.hpp"

namespace beamid::apps {

/// One record for each experiment file, in their order: those of the command line, or those that the files
/// name.
/// @throws UsageError, InputError
experiments::Results identify_family(const Values& values, const std::vector<std::filesystem::path>& configs);

}  // namespace beamid::apps
