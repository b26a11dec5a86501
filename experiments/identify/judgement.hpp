// Whether the result of an identification may be relied on, and what speaks against it.
#pragma once

#include <string>
#include <vector>

#include "experiments/identify/compare/comparison.hpp"

namespace beamid::experiments {

struct RecordIdentification;

/// The verdict on an identification, with its reasons.
struct Judgement {
  ComparedRun::Status verdict = ComparedRun::Status::converged;
  std::vector<std::string> messages;  ///< for the first lines of a report, the worst first; empty: none
};

/// The verdict and, where the filter diverged or its intervals and those of the modal analysis exclude each
/// other, a message with the cause that a test supports, the first of:
///
/// - the discretisation: its closed form makes of the modal analysis' K and C what the filter found;
/// - the prior, where what it states excludes the modal analysis by more than three of its deviations;
/// - a stated noise that is less than a tenth of what the record has near the mode;
/// - another mode beside this one, which the modal analysis fitted along;
/// - damping and frequency that vary with amplitude (amplitude_sections.hpp);
/// - noise that is larger where the amplitude is: rattle, or modes that die out;
/// - the modal analysis, where its modes leave more of the record than the filter's does: it then contradicts
///   nothing.
///
/// Where the filter could not be checked, as there is no modal analysis, and where it leaves most of the
/// record, a message says that.
Judgement judge(const Experiment& experiment, const Record& record, const RecordIdentification& found);

}  // namespace beamid::experiments
