// Measured modes from a file: a TOML file of [[modes]], or the results.json of `beamid modal`.
#pragma once

#include <filesystem>

#include "experiments/config/channel_places.hpp"
#include "experiments/modal/modal_data.hpp"

namespace beamid::experiments {

/// TOML: one table [[modes]] for each mode with frequency_hz, frequency_standard_deviation_hz or
/// frequency_relative_deviation, shape (a number for each of the experiment's sensors, in their order),
/// shape_standard_deviation, and `mode`, its number, where it is known (docs/theory/updating.md).
///
/// JSON: what `beamid modal --out` writes. Channels belong to the sensors of their names or, where no name
/// is a sensor's, in their order; accelerations and velocities become displacements by powers of i omega,
/// complex shapes the real ones nearest to them. Of several records the merged frequencies are used.
///
/// Modes are sorted by frequency; where the file has another order, a remark says so.
/// @throws InputError naming place, what was found and what was expected.
ModalData read_modal_data(const std::filesystem::path& file, const Experiment& experiment);

}  // namespace beamid::experiments
