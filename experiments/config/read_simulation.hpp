// The tables [excitation], [[sensors]] and [simulation] of an experiment file.
#pragma once

#include <vector>

#include "experiments/config/acquisition_settings.hpp"
#include "experiments/config/settings.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments {

/// @param structure to which every place must belong.
/// @throws InputError for a missing, a useless or a bad value.
Excitation read_excitation(const TomlTable& table, const fem::Structure& structure);

/// Each of [[excitations]], which act at the same time; none without.
/// @param root of the file. @throws InputError also beside [excitation].
std::vector<Excitation> read_simultaneous_excitations(const TomlTable& root, const fem::Structure& structure);

/// @param root of the file.
std::vector<Sensor> read_sensors(const TomlTable& root, const fem::Structure& structure);

/// What each of the sensors does wrong. @param root of the file.
std::vector<SensorDefects> read_defects(const TomlTable& root);

/// Keys that are none of its own are options of the method. @throws InputError as above, and for unknown
/// options.
Simulation read_simulation(const TomlTable& table);

}  // namespace beamid::experiments
