// The modes of a driven record, as a user sees them.
#pragma once

#include "experiments/modal/study/driven_study.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// A section for each record; figures, results.json.
Results report(const ModalStudySettings& settings, const std::vector<DrivenStudy>& studies);

}  // namespace beamid::experiments
