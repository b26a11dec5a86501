// The table [system] of an experiment file: matrices of the user's own.
#pragma once

#include "experiments/text/toml_table.hpp"
#include "fem/matrix_system.hpp"

namespace beamid::experiments {

/// Matrices are Matrix Market files beside the experiment file.
/// @throws InputError at a key, in a matrix's file, and where sizes differ.
fem::MatrixSystem read_system(const TomlTable& table);

}  // namespace beamid::experiments
