// What several records of one beam show, as one.
#pragma once

#include <vector>

#include "experiments/identify/model_check/model_check.hpp"
#include "experiments/modal/study/modal_study.hpp"

namespace beamid::experiments {

/// The modes of all records, merged (merged_modes.hpp), each with the records that show it; the larger of the
/// two deviations counts.
std::vector<ObservedMode> observed_modes(const std::vector<RecordModes>& records);

}  // namespace beamid::experiments
