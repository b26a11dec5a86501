// What `beamid identify` is asked to identify: records, each with the experiment as it holds for it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/command.hpp"
#include "apps/values.hpp"
#include "experiments/identify/identification_request.hpp"

namespace beamid::apps {

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
