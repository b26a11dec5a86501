// What of a record's parameters is one answer of several, as a user sees it.
#pragma once

#include "experiments/identify/twins/record_twins.hpp"
#include "experiments/results/results.hpp"
#include "experiments/studies/update/report.hpp"

namespace beamid::experiments {

// Sets of parameters with the same modes, as a user sees them.

/// The sets first, then how complete they are and what would decide.
Results twins_report(const Experiment& experiment, const UpdateStudy& study);

/// Their table, what would decide, and "twins" of results.json; nothing where none was tried.
void add_twins(Results& results, const ComparedRun& run, const RecordTwins& twins);

}  // namespace beamid::experiments
