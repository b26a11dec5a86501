// Virtual sensing, as a user sees it.
#pragma once

#include "experiments/identify/sensing/sensing.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// First whether the result may be trusted: sensors that the others contradict, what no sensor determines;
/// then histories with their errors, the sensors left out, constants, damage. Writes sensed.csv.
/// @param record its name
Results sensing_report(const Experiment& experiment, const SensingStudy& study, const std::string& record);

/// "record.csv: 4001 samples, 6 coordinates (none), 1 unknown force." @param record its name
std::string sensing_sentence(const SensingStudy& study, const std::string& record);

/// What speaks against the structure, its sensors and its forces as described.
void add_sensing_verdict(const SensingStudy& study, Results& results);

}  // namespace beamid::experiments
