// Higher modes are no noise: they are kept from a filter that knows one mode.
#pragma once

#include <optional>

#include "experiments/config/experiment.hpp"
#include "experiments/record/record.hpp"

namespace beamid::experiments {

/// A step `decimate` to eight samples per cycle, where the spectrum of what the mode leaves has a line above
/// twice its frequency more than six times the noise at the mode: a filter of one mode takes that for white
/// noise, errs by a share of its deviation that grows with that ratio (1 at a ratio of 40 over 30 cycles),
/// and loses the mode where another is larger. Finite low-passes leave frequency and damping as they are.
/// Nothing where no line is as high, or the record has too few samples per cycle.
/// @throws as identify_record()
std::optional<Choice> step_against_higher_modes(const Experiment& experiment, const Record& record);

}  // namespace beamid::experiments
