// Why a filter and the modal analysis of the same record contradict each other.
#pragma once

#include <string>

#include "experiments/identify/record_identification.hpp"

namespace beamid::experiments {

// Each cause as part of a sentence; empty where it is not the one.
std::string by_discretisation(const Record& record, const RecordIdentification& found);
std::string by_prior(const Prior& prior, const RecordIdentification& found);
std::string by_stated_noise(const RecordIdentification& found);
std::string by_companion(const RecordIdentification& found);
std::string by_amplitude(const RecordIdentification& found);
std::string by_unsteady_noise(const RecordIdentification& found);

/// A line at a multiple of the mode's frequency: readings cut off that no test of runs has found, or a
/// stiffness that is not linear. It belongs to the motion that is identified, so that no fit of two modes
/// helps.
std::string by_overtone(const RecordIdentification& found);

/// Whether the modal analysis' modes leave clearly more of the record than the filter's.
bool modal_analysis_is_worse(const Record& record, const RecordIdentification& found);

/// The first of the causes but the overtone, in the order of judge().
std::string cause_of(const Experiment& experiment, const Record& record, const RecordIdentification& found);

}  // namespace beamid::experiments
