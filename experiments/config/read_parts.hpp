// [[substructures]] of an experiment file.
#pragma once

#include <vector>

#include "experiments/config/settings.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments {

/// The parts in the order of the file; none without.
/// @param structure whose sections or places they are between
/// @throws InputError for a missing, a useless or a bad value, and where a name is there twice.
std::vector<PartOfStructure> read_parts(const TomlTable& root, const fem::Structure& structure);

}  // namespace beamid::experiments
