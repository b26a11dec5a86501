// The mode of a record and the noise near it, without what is found beside them.
#pragma once

#include "experiments/identify/analysis.hpp"

namespace beamid::experiments {

/// As analyse(), for decisions before the identification: no overtone, no jump of the frequency, no sections,
/// no comparison of the channels. @throws as analyse()
RecordAnalysis analyse_mode(const Experiment& experiment, const Record& record);

}  // namespace beamid::experiments
