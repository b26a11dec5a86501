// The table [system] of an experiment file: matrices of the user's own.
#pragma once

#include <vector>

#include "experiments/config/channel_places.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/matrix_system.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments {

// [[substructures]] of an experiment file.

/// The parts in the order of the file; none without.
/// @param structure whose sections or places they are between
/// @throws InputError for a missing, a useless or a bad value, and where a name is there twice.
std::vector<PartOfStructure> read_parts(const TomlTable& root, const fem::Structure& structure);

/// Matrices are Matrix Market files beside the experiment file.
/// @throws InputError at a key, in a matrix's file, and where sizes differ.
fem::MatrixSystem read_system(const TomlTable& table);

}  // namespace beamid::experiments
