// The table [chain] of an experiment file.
#pragma once

#include <vector>

#include "experiments/models/springs/storey_spring.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/beam.hpp"

namespace beamid::experiments {

/// Floors on storeys, or layers of soil in [[chain.layers]], as fem/shear_building.hpp makes a beam of them.
/// @throws InputError where the numbers of values differ, at a missing or a useless key
fem::Beam read_chain(const TomlTable& table);

/// [[chain.storeys]]: the laws of storeys that are not linear, by storey.
/// @throws InputError at a storey that there is not, or twice, at an unknown law, and where a parameter of
/// the law is missing or out of range
std::vector<StoreySpring> read_storey_springs(const TomlTable& table, const fem::Beam& chain);

/// @throws InputError at a place between floors.
void check_places_on_chain(const TomlTable& root, const fem::Beam& chain);

}  // namespace beamid::experiments
