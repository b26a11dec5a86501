// Which identified mode belongs to which predicted one.
#pragma once

#include "experiments/identify/model_check/model_check.hpp"

namespace beamid::experiments {

inline constexpr double most_apart = 0.3;  ///< of identified and predicted frequency, |ln|

/// Adds a structure's modes, strays and contradictions to the check, by the scores of update
/// (mode_pairing.hpp).
void match_modes(const CheckedStructure& structure, std::size_t number, ModelCheck& check);

}  // namespace beamid::experiments
