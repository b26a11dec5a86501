// The tables [excitation], [[sensors]] and [simulation] of an experiment file.
#pragma once

#include <vector>

#include "experiments/config/settings.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

/// @param length of the beam, to which every position must belong [m].
/// @throws InputError for a missing, a useless or a bad value.
Excitation read_excitation(const TomlTable& table, double length);

/// @param table the file's root.
std::vector<Sensor> read_sensors(const TomlTable& table, const fem::Beam& beam);

/// Keys that are none of its own are options of the method. @throws InputError as above, and for unknown
/// options.
Simulation read_simulation(const TomlTable& table);

}  // namespace beamid::experiments
