// Keys and their values, as results.json holds them.
#pragma once

#include <nlohmann/json.hpp>

#include "experiments/config/schema.hpp"

namespace beamid::experiments {

/// {"position_m": 1.1, "mass_kg": 0.36}
nlohmann::ordered_json to_json(const std::vector<std::pair<std::string, KeyValue>>& values);

}  // namespace beamid::experiments
