// The table [beam] of an experiment file.
#pragma once

#include "experiments/input/toml_table.hpp"
#include "fem/cantilever.hpp"

namespace beamid::experiments {

/// EI is given as such or as E with the rectangular section, E I = E width height^3 / 12; the beam's mass in
/// total, per length or as a density with the section. The sensor's mass rides on the tip and is added to the
/// tip mass.
/// @throws InputError for missing or contradicting keys at the table's place, for a bad value at its own.
fem::Beam read_beam(const TomlTable& table);

}  // namespace beamid::experiments
