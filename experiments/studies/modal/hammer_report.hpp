// A hammer test as text, tables, figures and JSON.
#pragma once

#include "experiments/modal/study/hammer_study.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// As a user sees it: modes with modal masses, responses with what the modes make of them, coherence.
Results report(const ModalStudySettings& settings, const HammerStudy& study);

}  // namespace beamid::experiments
