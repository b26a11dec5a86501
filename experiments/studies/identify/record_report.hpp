// An identification of one record as text, tables, figures and JSON.
#pragma once

#include "experiments/identify/record_identification.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// Tables, figures, words and results.json keys.
Results report(const Experiment& experiment, const Record& record, const std::string& record_name,
               const RecordIdentification& found);

}  // namespace beamid::experiments
