// The table [chain] of an experiment file.
#pragma once

#include "experiments/text/toml_table.hpp"
#include "fem/beam.hpp"

namespace beamid::experiments {

/// Floors on storeys, or layers of soil in [[chain.layers]], as fem/shear_building.hpp makes a beam of them.
/// @throws InputError where the numbers of values differ, at a missing or a useless key
fem::Beam read_chain(const TomlTable& table);

/// @throws InputError at a place between floors.
void check_places_on_chain(const TomlTable& root, const fem::Beam& chain);

}  // namespace beamid::experiments
