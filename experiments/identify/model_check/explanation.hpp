// What one change, or two together, make of the differences.
#pragma once

#include "experiments/identify/model_check/model_check.hpp"

namespace beamid::experiments {

/// update (update/updating.hpp) of the changes alone: the same residual, search, intervals and limits. An
/// interval does not leave what is possible; of one change that is held by a bound it begins there.
Explanation explain(const ModelCheck& check, const std::vector<std::size_t>& which);

/// Of the structures as described, without their shapes' scales: chi^2, and numbers that are independent.
std::pair<double, Eigen::Index> described_fit(const ModelCheck& check);

}  // namespace beamid::experiments
