// A model check as a user sees it.
#pragma once

#include "experiments/identify/model_check/model_check.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// Tables of modes, of what candidates do, of what explains; words, a figure, results.json.
Results report(const ModelCheck& check);

/// Configuration and values of results.json.
void fill_model_check_values(const ModelCheck& check, Results& results);

/// "Neither ... alone": what the data say about the candidates, a sentence each.
std::vector<std::string> conclusions(const ModelCheck& check);

}  // namespace beamid::experiments
