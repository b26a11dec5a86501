// The unit of the times that a file states.
#pragma once

#include <optional>
#include <string>

#include "experiments/record/record_format.hpp"

namespace beamid::experiments {

/// How many seconds a unit of time is, as a file spells it; an empty one is taken for the second.
/// @param what has it, for messages: "'/run/time'".
/// @returns nothing for another unit where the format states the times' unit or rate itself.
/// @throws InputError for another unit where it does not.
std::optional<double> seconds_per(const std::string& unit, const std::string& what, const std::string& file,
                                  const RecordFormat& format);

}  // namespace beamid::experiments
