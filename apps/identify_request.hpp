// What `beamid identify` is asked to identify: records, each with the experiment as it holds for it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/command.hpp"
#include "apps/values.hpp"
#include "experiments/identify/engine/identification_request.hpp"
#include "experiments/results/results.hpp"

namespace beamid::apps {

// beamid identify --config A --config B ...: several beams at once.

/// One record for each experiment file, in their order: those of the command line, or those that the files
/// name.
/// @throws UsageError, InputError
experiments::Results identify_family(const Values& values, const std::vector<std::filesystem::path>& configs);

/// One record of the command; its experiment includes what the command line says.
using IdentifyRequest = experiments::IdentificationRequest;

/// The options that say what to identify, beside RECORD.
OptionGroup identify_options();

/// What --damping-law asks for; empty: nothing. @throws UsageError
std::string damping_law(const Values& values);

/// Every RECORD of the command line, or the experiment file's, read and prepared.
/// @throws UsageError, InputError
std::vector<IdentifyRequest> identify_requests(const Values& values, const std::filesystem::path& config);

}  // namespace beamid::apps
