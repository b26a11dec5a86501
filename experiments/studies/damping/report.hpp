// The law of damping of one record as text, tables, figures and JSON.
#pragma once

#include "experiments/identify/damping_law/damping_law.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// Tables, figures, words and results.json keys of `beamid identify --damping-law`.
Results report(const Experiment& experiment, const Record& record, const std::string& record_name,
               const DampingLawStudy& study);

}  // namespace beamid::experiments
