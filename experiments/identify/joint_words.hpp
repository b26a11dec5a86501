// Sentences on whether records agree.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/identify/joint_estimate.hpp"

namespace beamid::experiments {

/// @param names of the unknowns (q)
std::string agreement_words(const JointEstimate& estimate, const std::vector<std::string>& names);

/// `agreement` of results.json.
nlohmann::ordered_json agreement_values(const JointEstimate& estimate, const std::vector<std::string>& names);

}  // namespace beamid::experiments
