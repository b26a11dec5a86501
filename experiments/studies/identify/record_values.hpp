// The numbers of an identification, as they stand in results.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/identify/identified_parameters.hpp"

namespace beamid::experiments {

/// The keys of results.json.
nlohmann::ordered_json values(const RecordIdentification& found, const Record& record);

/// All that was set, given or worked out.
nlohmann::ordered_json configuration(const Experiment& experiment, const Record& record,
                                     const RecordIdentification& found, const std::string& record_name);

}  // namespace beamid::experiments
