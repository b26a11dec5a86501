// Higher modes are no noise: they are kept from a filter that knows one mode.
#pragma once

#include <optional>

#include "experiments/experiment.hpp"
#include "experiments/record.hpp"

namespace beamid::experiments {

/// A step `decimate` to eight samples per cycle, where more than three times the noise near the mode is left
/// elsewhere in the spectrum: a filter of one mode takes that for white noise, and loses the mode where
/// another is larger. Finite low-passes leave frequency and damping as they are. Nothing where the record is
/// as white as that, or has too few samples per cycle. @throws as identify_record()
std::optional<Choice> step_against_higher_modes(const Experiment& experiment, const Record& record);

}  // namespace beamid::experiments
