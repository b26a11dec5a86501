// [[unknown_forces]], [[virtual_sensors]] and [fatigue] of an experiment file.
#pragma once

#include <vector>

#include "experiments/config/sensing_settings.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments {

/// In the order of the file; none without.
/// @throws InputError for a missing, a useless or a bad value, and where a name is there twice.
std::vector<UnknownForce> read_unknown_forces(const TomlTable& root, const fem::Structure& structure);
std::vector<VirtualSensor> read_virtual_sensors(const TomlTable& root, const fem::Structure& structure);
std::optional<FatigueLaw> read_fatigue(const TomlTable& root);

/// A sensor of the bending moment at a section, M = E I w'' [N m]: distance is -E I there.
/// @throws std::invalid_argument where the structure has no sections
VirtualSensor bending_moment_at(const fem::Beam& beam, double position);

}  // namespace beamid::experiments
