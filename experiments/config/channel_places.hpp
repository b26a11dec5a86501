// Where on the beam the channels of a record sit, and how that is said.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "experiments/config/experiment.hpp"

namespace beamid::experiments {

/// The record with a position for every channel, and a distance from the axis for every strain gauge. A
/// channel that has none is given that of, in this order:
///
/// 1. the sensor of its quantity in [[sensors]] that has its name, or is the only one of that quantity;
/// 2. its name, as simulated records have it: "tip", "root", "x0.25m";
/// 3. the beam's natural point, where that is no guess between several places: no other channel of its
/// quantity
///    is left without a position, and [[sensors]] names none.
///
/// @throws std::invalid_argument where none of that holds: a model would read the channel at the wrong place.
Record with_places(Record record, const Experiment& experiment);

/// "tip: acceleration at 0.5 m".
std::string channel_text(const Channel& channel);

/// The same of all, separated by commas.
std::string channels_text(const Record& record);

/// Name, quantity, unit and position of every channel, for results.json.
nlohmann::ordered_json channel_values(const Record& record);

}  // namespace beamid::experiments
