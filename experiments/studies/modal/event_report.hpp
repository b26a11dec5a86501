// A column of soil, or a building, in one earthquake after the other.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/record/record.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// f1 and xi of every record (modal/base_response.hpp) beside its peak acceleration: a table `events`, and a
/// figure `events` of both over the peak.
///
/// Of several accelerometers the last one counts: of files with a surface and a borehole the surface.
/// @throws std::invalid_argument where a record has no base_acceleration or no acceleration, beginning with
/// its name.
Results event_report(const std::vector<std::string>& names, const std::vector<Record>& records,
                     const std::optional<std::pair<double, double>>& band_hz);

}  // namespace beamid::experiments
